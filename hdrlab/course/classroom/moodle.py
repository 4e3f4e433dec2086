"""Tables and feedback files for Moodle.

Moodle's gradebook imports any table whose columns are then mapped [Moodle Docs, Grade import]. An
assignment knows students only by its own numbers, which are in the grading worksheet that it
exports. So hdrlab fills in that worksheet and names the feedback files by it [Moodle Docs, Using
Assignment; the names in the archive as in assignfeedback_file_zip_importer]. The filled worksheet
has a column of comments only if the instructor has written some for hdrlab; otherwise an import
leaves the comments in Moodle as they are.
"""

import re
from collections.abc import Sequence
from pathlib import Path

from hdrlab.course.classroom import jobs
from hdrlab.course.classroom.marks import MAX_GRADEBOOK_BYTES, NOT_GRADED, GradebookRow
from hdrlab.course.plan import Homework
from hdrlab.course.students import csv_tables
from hdrlab.course.students.roster import Roster, Student, fold
from hdrlab.course.submissions.archives.packing import make_zip
from hdrlab.errors import InputError

# Columns of a worksheet that may identify a student.
ID_COLUMNS = ("id number", "username", "email address")
REQUIRED_COLUMNS = ("identifier", "grade", "maximum grade", "last modified (grade)")
WORKSHEET_COLUMNS = ("Identifier", "Full name", "Grade", "Last modified (grade)")
COMMENT_COLUMN = "Feedback comments"
FEEDBACK_NAME = "Participant_{}_assignsubmission_file_feedback.html"


def gradebook(
    rows: Sequence[GradebookRow], roster: Roster, homework: Homework
) -> tuple[list[str], list[list[csv_tables.Cell]]]:
    """Return header and rows of the table that Moodle's gradebook imports, without held scores."""
    header = ["ID number", "Username", "Email address", f"{homework.name}: {homework.title}"]
    emails = {student.id: student.email for student in roster.students}
    table: list[list[csv_tables.Cell]] = []
    for row in rows:
        score = None if row.hold else row.score
        table.append([row.student, row.student, emails[row.student], score])
    return header, table


def write(
    out: Path,
    worksheet: Path,
    rows: Sequence[GradebookRow],
    roster: Roster,
    homework: Homework,
) -> list[str]:
    """Write moodle_worksheet.csv and moodle_feedback.zip; return a note for each unknown student.

    A student whose work has not been graded, or whose score is held back, keeps the grade that the
    worksheet has.

    Raises
    ------
    InputError
        For a file that is no grading worksheet, or whose maximum grade differs from the points of
        the homework.
    """
    rows_by_student = {row.student: row for row in rows}
    has_comments = any(row.comment for row in rows)
    students = _students_by_name(roster)
    lines: list[list[csv_tables.Cell]] = []
    feedback_files: dict[str, bytes] = {}
    notes = []
    for line in read_worksheet(worksheet, homework):
        student = _find_student(line, students)
        found_row = None if student is None else rows_by_student[student.id]
        full_name = line.get("full name", "")
        grade: csv_tables.Cell = line["grade"]
        if found_row is None:
            notes.append(f"{worksheet.name}: {full_name!r} is not in the roster")
        elif _is_published(found_row):
            grade = found_row.score
            page = out / "feedback" / found_row.team / "feedback.html"
            number = _participant_number(line)
            if number and page.is_file():
                feedback_files[FEEDBACK_NAME.format(number)] = page.read_bytes()
        cells: list[csv_tables.Cell] = [
            line["identifier"],
            full_name,
            grade,
            line["last modified (grade)"],
        ]
        if has_comments:
            comment = found_row.comment if found_row and not found_row.hold else ""
            cells.append(comment or line.get(COMMENT_COLUMN.lower(), ""))
        lines.append(cells)
    columns = [*WORKSHEET_COLUMNS, COMMENT_COLUMN] if has_comments else WORKSHEET_COLUMNS
    csv_tables.write_csv(out / "moodle_worksheet.csv", columns, lines, private=True)
    jobs.write_private_file(out / "moodle_feedback.zip", make_zip(feedback_files))
    return notes


def read_worksheet(worksheet: Path, homework: Homework) -> list[dict[str, str]]:
    """Return the lines of an assignment's grading worksheet, by the lower-case names of its columns.

    Raises
    ------
    InputError
        For a file that is no grading worksheet, or whose maximum grade differs from the points of
        the homework.
    """
    lines = csv_tables.read_csv(worksheet, max_bytes=MAX_GRADEBOOK_BYTES)
    for number, line in enumerate(lines, 2):
        _check_line(f"{worksheet}, line {number}", line, homework)
    return lines


def find_teams_by_number(worksheet: Path, roster: Roster, homework: Homework) -> dict[str, str]:
    """Return the team of each participant in a worksheet whom the roster has, by the number."""
    teams = {}
    students = _students_by_name(roster)
    for line in read_worksheet(worksheet, homework):
        student = _find_student(line, students)
        number = _participant_number(line)
        if student is not None and number:
            teams[number] = student.team
    return teams


def _check_line(place: str, line: dict[str, str], homework: Homework) -> None:
    """Raise InputError for a line that is not of the worksheet of this homework."""
    for column in REQUIRED_COLUMNS:
        if column not in line:
            raise InputError(
                f"{place}: expected a Moodle grading worksheet in English, "
                f"but it has no column {column!r}"
            )
    max_grade = line["maximum grade"]
    if not max_grade:
        return
    try:
        points = float(max_grade.replace(",", "."))  # some languages write 100,00
    except ValueError:
        raise InputError(
            f"{place}: expected a number in the column 'maximum grade', got {max_grade!r}"
        ) from None
    if points != homework.points:
        raise InputError(
            f"{place}: expected a maximum grade of {homework.points:g} points, as "
            f"{homework.name} gives, got {max_grade}; set it in the assignment"
        )


def _is_published(row: GradebookRow) -> bool:
    """Return whether a student gets the score: for graded work, or for points by hand alone."""
    is_graded = bool(row.received) and not row.note.startswith(NOT_GRADED)
    return not row.hold and (is_graded or row.by_hand != 0)


def _participant_number(line: dict[str, str]) -> str:
    """Return the number of the participant in a line of the worksheet, or ""."""
    number = re.search(r"\d+$", line["identifier"])
    return number[0] if number else ""


def _students_by_name(roster: Roster) -> dict[str, Student]:
    """Return the students by their ids and their email addresses."""
    students = {}
    for student in roster.students:
        for name in (student.id, student.email):
            if name:
                students[fold(name)] = student
    return students


def _find_student(line: dict[str, str], students: dict[str, Student]) -> Student | None:
    """Return the student in a line of the worksheet, or None for one who is not in the roster."""
    for column in ID_COLUMNS:
        student = students.get(fold(line.get(column, "")))
        if student is not None:
            return student
    return None
