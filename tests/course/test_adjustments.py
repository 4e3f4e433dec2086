"""Decisions of an instructor: extensions, points by hand, comments and withheld scores."""

import csv
from datetime import UTC, datetime, timedelta

import pytest

from hdrlab.course.classroom import marks, moodle, run as classroom
from hdrlab.course.plan import GradingOptions, Homework, Late, Task
from hdrlab.course.students import adjustments, csv_tables
from hdrlab.course.students.roster import Roster, Student
from hdrlab.course.submissions.class_folder import Submission

DUE = datetime(2026, 10, 9, 23, 59, tzinfo=UTC)
HOMEWORK = Homework("hw2", "The response curve", DUE, (Task("hat", "core.weights.hat", 100),))
ROSTER = Roster((Student("b1", "Ada", "t"), Student("b2", "Bo", "t"), Student("b3", "Cy", "b3")))
SUBMISSIONS = {
    "t": Submission("t", ("b1", "b2"), None, DUE + timedelta(days=3), "digest"),
    "b3": Submission("b3", ("b3",), None, DUE, "digest"),
}
POINTS = {"t": 80.0, "b3": 95.0}


@pytest.fixture
def read(tmp_path):
    def adjustments_of(text):
        path = tmp_path / "adjustments.csv"
        path.write_text(text, encoding="utf8")
        return adjustments.read(path, ROSTER)

    return adjustments_of


@pytest.fixture
def rows(read):
    """rows(text) -> the rows of the gradebook by student, with the adjustments of this table."""

    def with_adjustments(text):
        course = classroom.GradingContext(
            ROSTER, HOMEWORK, GradingOptions(), Late(0, 10.0), adjustments=read(text)
        )
        gradebook = marks.gradebook_rows(course, SUBMISSIONS, POINTS)
        return {row.student: row for row in gradebook}

    return with_adjustments


def test_an_extension_moves_the_due_date_of_one_student_only(rows):
    gradebook = rows("student,extension\nb1,2\n")
    assert [(gradebook[who].late, gradebook[who].score) for who in ("b1", "b2")] == [
        (1, 70),
        (3, 50),
    ]
    assert "extension of 2 days" in gradebook["b1"].note and not gradebook["b2"].note


def test_points_by_hand_are_added_after_the_penalty_and_may_be_extra_credit(rows):
    gradebook = rows("student,points\nb1,5\nb2,-60\nb3,12.5\n")
    assert [gradebook[who].score for who in ("b1", "b2", "b3")] == [55, 0, 107.5]
    assert gradebook["b3"].by_hand == 12.5


def test_a_held_score_is_in_the_gradebook_and_in_no_table_for_a_platform(rows):
    gradebook = rows("student,hold\nB3,yes\n")
    assert gradebook["b3"].score == 95
    lines = list(gradebook.values())
    _, canvas = marks.canvas_table(lines, HOMEWORK)
    _, table = moodle.gradebook(lines, ROSTER, HOMEWORK)
    assert [row[-1] for row in canvas[1:]] == [row[-1] for row in table] == [50, 50, None]


def test_a_comment_reaches_its_student_in_moodle_and_no_other_comment_is_lost(rows, tmp_path):
    gradebook = rows("student,comment,hold\nb1,Good curve.,\nb3,Talk to me.,yes\n")
    header = (
        *("Identifier", "ID number", "Grade", "Maximum grade", "Last modified (grade)"),
        "Feedback comments",
    )
    lines = [
        (f"Participant {number}", who, "", "100.00", "-", "Earlier.")
        for number, who in enumerate(("b1", "b2", "b3"), 1)
    ]
    csv_tables.write_csv(tmp_path / "sheet.csv", header, lines)
    moodle.write(tmp_path, tmp_path / "sheet.csv", list(gradebook.values()), ROSTER, HOMEWORK)
    with open(tmp_path / "moodle_worksheet.csv", encoding="utf-8-sig", newline="") as file:
        written = list(csv.DictReader(file))
    assert [row["Feedback comments"] for row in written] == ["Good curve.", "Earlier.", "Earlier."]
    assert [row["Grade"] for row in written] == ["50.0", "50.0", ""]


def test_several_tables_add_up_and_an_anonymous_reader_writes_codes(tmp_path):
    texts = (
        "student,extension,points,comment\nb1,2,5,Ill.\n",
        "student,points,comment,hold\nSCODE,-1.5,Good curve.,yes\nb3,4,,\n",
    )
    tables = []
    for number, text in enumerate(texts):
        path = tmp_path / f"{number}.csv"
        path.write_text(text)
        tables.append(adjustments.read(path, ROSTER, {"SCODE": "b1"}))
    assert adjustments.merge(tables) == {
        "b1": adjustments.Adjustment(2, 3.5, "Ill. Good curve.", True),
        "b3": adjustments.Adjustment(points=4),
    }


def test_points_by_hand_reach_moodle_also_without_a_submission(read, tmp_path):
    course = classroom.GradingContext(
        ROSTER, HOMEWORK, GradingOptions(), adjustments=read("student,points\nb3,40\n")
    )
    rows = marks.gradebook_rows(course, {}, {})
    header = ("Identifier", "ID number", "Grade", "Maximum grade", "Last modified (grade)")
    lines = [(f"Participant {who}", who, "7.00", "100.00", "-") for who in ("b1", "b2", "b3")]
    csv_tables.write_csv(tmp_path / "sheet.csv", header, lines)
    moodle.write(tmp_path, tmp_path / "sheet.csv", rows, ROSTER, HOMEWORK)
    written = csv_tables.read_csv(tmp_path / "moodle_worksheet.csv")
    assert [row["grade"] for row in written] == ["7.00", "7.00", "40.0"]


def test_the_gradebook_can_be_read_as_that_of_an_earlier_homework(rows, tmp_path):
    gradebook = rows("student,extension,points,comment,hold\nb1,2,5,Good.,yes\n")
    cells = [row.cells for row in gradebook.values()]
    csv_tables.write_csv(tmp_path / "gradebook.csv", marks.COLUMNS, cells)
    records = marks.read([tmp_path / "gradebook.csv"])
    assert [(record.students, record.late, record.points) for record in records] == [
        (("b1",), 1, 80),
        (("b2",), 3, 80),
        (("b3",), 0, 95),
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("student,grade\nb1,3\n", "expected the column student and any of"),
        ("student,points\nb9,3\n", "line 2.*'b9'"),
        ("student,points\nb1,3\nb1,4\n", "line 3.*b1 twice"),
        ("student,points\nb1,many\n", "line 2.*'points'.*'many'"),
        ("student,extension\nb1,1.5\n", "line 2.*'extension'"),
        ("student,extension\nb1,-1\n", "line 2.*'extension'"),
        ("student,hold\nb1,maybe\n", "line 2.*'hold'.*'maybe'"),
    ],
)
def test_an_error_names_the_line_and_the_column(text, message, read):
    with pytest.raises(ValueError, match=message):
        read(text)


def test_points_may_have_a_decimal_comma(read):
    assert read('student,points\nb1,"2,5"\n')["b1"].points == 2.5
