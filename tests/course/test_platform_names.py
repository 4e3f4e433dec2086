"""Files of a class as Moodle and Canvas name them in a download of all submissions."""

import pytest

from hdrlab.course.students.roster import Roster, Student
from hdrlab.course.submissions import class_folder

ROSTER = Roster(
    (
        Student("b1", "Ada Lovelace", "b1"),
        Student("b2", "Bo O'Neill-Li", "t2"),
        Student("b3", "Zoë Wang", "t2"),
        Student("b4", "Li Wei", "b4"),
        Student("b5", "Wei Li", "b5"),
    )
)


def find(tmp_path, name, **options):
    path = tmp_path / name
    path.parent.mkdir(exist_ok=True)
    path.write_text("x")
    return class_folder.find(tmp_path, ROSTER, **options)


@pytest.mark.parametrize(
    ("name", "team"),
    [
        ("Ada Lovelace_4711_assignsubmission_file_hw2.ipynb", "b1"),
        ("Ada Lovelace_4711_assignsubmission_file/hw2.ipynb", "b1"),
        ("Ada Lovelace_4711_assignsubmission_file_/hw2.ipynb", "b1"),
        ("Lovelace Ada_4711_assignsubmission_file_b2_hw2.py", "b1"),
        ("Bo O'Neill-Li_4712_assignsubmission_file_hw2.zip", "t2"),
        ("lovelaceada_815_4711_hw2.ipynb", "b1"),
        ("lovelaceada_LATE_815_4711_hw2-1.ipynb", "b1"),
        ("oneilllibo_816_4712_hw2.ipynb", "t2"),
        ("wangzoë_817_4713_b1_hw2.ipynb", "t2"),
    ],
)
def test_the_student_is_found_by_the_name_that_the_platform_gives(name, team, tmp_path):
    assert list(find(tmp_path, name).submissions) == [team]


@pytest.mark.parametrize(
    "name",
    [
        "Eve Hacker_9_assignsubmission_file_Ada Lovelace_4711_assignsubmission_file_hw2.ipynb",
        "hackereve_9_9_lovelaceada_815_4711_hw2.ipynb",
        "Ada Lovelace.ipynb",
        "lovelaceada_hw2.ipynb",
    ],
)
def test_a_name_in_the_students_own_part_of_the_name_does_not_count(name, tmp_path):
    scan = find(tmp_path, name)
    assert scan.submissions == {} and "no student" in scan.notes[0]


def test_a_file_that_may_belong_to_two_students_is_assigned_to_neither(tmp_path):
    scan = find(tmp_path, "weili_1_2_hw2.ipynb")
    assert scan.submissions == {} and "b4 or b5" in scan.notes[0]


def test_the_number_in_the_worksheet_distinguishes_students_of_the_same_name(tmp_path):
    name = "Wei Li_4711_assignsubmission_file_hw2.ipynb"
    assert list(find(tmp_path, name, teams_by_number={"4711": "b4"}).submissions) == ["b4"]


def test_an_anonymous_participant_is_found_by_the_number(tmp_path):
    name = "Participant_4711_assignsubmission_file_hw2.ipynb"
    assert find(tmp_path, name).submissions == {}
    assert list(find(tmp_path, name, teams_by_number={"4711": "b1"}).submissions) == ["b1"]
