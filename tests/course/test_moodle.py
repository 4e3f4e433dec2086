"""Files for Moodle: grades and feedback in the form that its importers expect."""

import csv
import io
import zipfile
from datetime import UTC, datetime, timedelta

import pytest

from hdrlab.course.classroom import marks, moodle, run as classroom
from hdrlab.course.plan import GradingOptions, Homework, Late, Task
from hdrlab.course.students import csv_tables
from hdrlab.course.students.roster import Roster, Student
from hdrlab.course.submissions.class_folder import Submission

DUE = datetime(2026, 10, 9, 23, 59, tzinfo=UTC)
HOMEWORK = Homework("hw2", "The response curve", DUE, (Task("hat", "core.weights.hat", 100),))
ROSTER = Roster(
    (
        Student("b1", "Ada", "t", "ada@example.edu"),
        Student("b2", "=Bo", "t"),
        Student("b3", "Cy", "b3", "cy@example.edu"),
        Student("b4", "Di", "b4"),
    )
)
HEADER = (
    *("Identifier", "Full name", "ID number", "Email address", "Status", "Grade", "Maximum grade"),
    *("Grade can be changed", "Last modified (submission)", "Online text", "Last modified (grade)"),
    "Feedback comments",
)


def row(number, name, id="", email="", grade="", most="100.00", text=""):
    return (
        f"Participant {number}",
        name,
        id,
        email,
        "Submitted",
        grade,
        most,
        "Yes",
        "-",
        text,
        "-",
        "Well",
    )


WORKSHEET = [
    row(4711, "Ada L_ovelace", "B1"),
    row(4712, "Bo", "b2", text="b3"),
    row(4713, "Cy", email="Cy@Example.edu", grade="12.00"),
    row(4714, "Eve", "b99", text="b1"),
    row(4715, "Di", "b4", grade="55.00"),
]


@pytest.fixture
def rows():
    course = classroom.GradingContext(ROSTER, HOMEWORK, GradingOptions(), Late(0, 1.0))
    handins = {
        "t": Submission("t", ("b1", "b2"), None, DUE + timedelta(days=2), "digest"),
        "b3": Submission("b3", ("b3",), None, DUE, "digest"),
    }
    return marks.gradebook_rows(course, handins, {"t": 90.5})


@pytest.fixture
def write(tmp_path, rows):
    (tmp_path / "feedback" / "t").mkdir(parents=True)
    (tmp_path / "feedback" / "t" / "feedback.html").write_text("<p>of t")

    def written(lines=WORKSHEET, header=HEADER):
        csv_tables.write_csv(tmp_path / "sheet.csv", header, lines)
        return moodle.write(tmp_path, tmp_path / "sheet.csv", rows, ROSTER, HOMEWORK)

    return written


def importer(name):
    """Return participant, plugin and file as Moodle's importer reads them from a path."""
    if name.startswith((".", "~")):
        return None
    parts = name.split("_", 4)
    return (int(parts[1]), parts[2] + "_" + parts[3], parts[4]) if len(parts) == 5 else None


def test_the_moodle_table_identifies_a_student_in_three_ways_and_has_the_score_after_the_penalty(
    rows,
):
    header, lines = moodle.gradebook(rows, ROSTER, HOMEWORK)
    read = list(csv.reader(io.StringIO(csv_tables.csv_text(header, lines))))
    assert read[0] == ["ID number", "Username", "Email address", "hw2: The response curve"]
    assert read[1] == ["b1", "b1", "ada@example.edu", "88.5"]
    assert [line[3] for line in read[1:]] == ["88.5", "88.5", "0.0", "0.0"]


def test_a_moodle_worksheet_keeps_its_columns_and_gets_the_scores(write, tmp_path):
    write()
    with open(tmp_path / "moodle_worksheet.csv", encoding="utf-8-sig", newline="") as file:
        lines = list(csv.DictReader(file))
    assert {"Identifier", "Grade", "Last modified (grade)"} <= set(lines[0])
    assert "Feedback comments" not in lines[0]
    grades = {line["Identifier"].removeprefix("Participant "): line["Grade"] for line in lines}
    assert grades == {"4711": "88.5", "4712": "88.5", "4713": "12.00", "4714": "", "4715": "55.00"}


def test_each_team_member_gets_the_feedback_page_in_moodles_archive(write, tmp_path):
    write()
    with zipfile.ZipFile(tmp_path / "moodle_feedback.zip") as archive:
        files = {importer(name): archive.read(name) for name in archive.namelist()}
    kind = "assignsubmission_file"
    page = b"<p>of t"
    assert files == {(4711, kind, "feedback.html"): page, (4712, kind, "feedback.html"): page}


def test_students_missing_from_the_roster_are_reported_and_names_in_student_text_are_ignored(
    write,
):
    (warning,) = write()
    assert "sheet.csv" in warning and "'Eve'" in warning


def test_a_worksheet_with_other_points_or_other_columns_is_refused(write):
    with pytest.raises(ValueError, match=r"10\.00"):
        write([row(4711, "Ada", "b1", most="10.00")])
    with pytest.raises(ValueError, match="identifier"):
        write([("4711", "90")], header=("ID", "Bewertung"))


def test_a_worksheet_may_have_decimal_commas(write):
    write([row(4711, "Ada", "b1", grade="12,50", most="100,00")])


def test_an_unreadable_maximum_is_named_by_line_and_column(write):
    with pytest.raises(ValueError, match="line 3.*'maximum grade'.*'many'"):
        write([row(4711, "Ada", "b1"), row(4712, "Bo", "b2", most="many")])
