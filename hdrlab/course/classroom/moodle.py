"""Tables and feedback files for Moodle.

Moodle's gradebook imports any table whose columns are then mapped [Moodle Docs, Grade import]. An
assignment knows students only by its own numbers, which are in the grading worksheet that it
exports. So hdrlab fills in that worksheet and names the feedback files by it [Moodle Docs, Using
Assignment; the names in the archive as in assignfeedback_file_zip_importer]. The filled worksheet
has no column of comments, so an import leaves a teacher's comments as they are.
"""

import re
from collections.abc import Sequence
from pathlib import Path

from hdrlab.course.classroom import jobs
from hdrlab.course.classroom.marks import MAX_GRADEBOOK_BYTES, NOT_GRADED, GradebookRow
from hdrlab.course.plan import Homework
from hdrlab.course.students import csv_tables
from hdrlab.course.students.roster import Roster, fold
from hdrlab.course.submissions.archives.packing import make_zip
from hdrlab.errors import InputError

# Columns of a worksheet that may identify a student.
ID_COLUMNS = ("id number", "username", "email address")
REQUIRED_COLUMNS = ("identifier", "grade", "maximum grade", "last modified (grade)")
WORKSHEET_COLUMNS = ("Identifier", "Full name", "Grade", "Last modified (grade)")
FEEDBACK_NAME = "Participant_{}_assignsubmission_file_feedback.html"


def gradebook(
    rows: Sequence[GradebookRow], roster: Roster, homework: Homework
) -> tuple[list[str], list[list[csv_tables.Cell]]]:
    """Return header and rows of the table that Moodle's gradebook imports."""
    header = ["ID number", "Username", "Email address", f"{homework.name}: {homework.title}"]
    emails = {student.id: student.email for student in roster.students}
    return header, [[row.student, row.student, emails[row.student], row.score] for row in rows]


def write(
    out: Path,
    worksheet: Path,
    rows: Sequence[GradebookRow],
    roster: Roster,
    homework: Homework,
) -> list[str]:
    """Write moodle_worksheet.csv and moodle_feedback.zip; return a note for each unknown student.

    A student whose work has not been graded keeps the grade that the worksheet has.

    Raises
    ------
    InputError
        For a file that is no grading worksheet, or whose maximum grade differs from the points of
        the homework.
    """
    rows_by_name: dict[str, GradebookRow] = {}
    for row, student in zip(rows, roster.students, strict=True):
        for name in (student.id, student.email):
            if name:
                rows_by_name[fold(name)] = row
    lines: list[list[csv_tables.Cell]] = []
    feedback_files: dict[str, bytes] = {}
    notes = []
    for line in csv_tables.read_csv(worksheet, max_bytes=MAX_GRADEBOOK_BYTES):
        _check_line(worksheet, line, homework)
        found_row = _find_row(line, rows_by_name)
        full_name = line.get("full name", "")
        grade: csv_tables.Cell = line["grade"]
        if found_row is None:
            notes.append(f"{worksheet.name}: {full_name!r} is not in the roster")
        elif found_row.received and not found_row.note.startswith(NOT_GRADED):
            grade = found_row.score
            page = out / "feedback" / found_row.team / "feedback.html"
            number = re.search(r"\d+$", line["identifier"])
            if number and page.is_file():
                feedback_files[FEEDBACK_NAME.format(number[0])] = page.read_bytes()
        lines.append([line["identifier"], full_name, grade, line["last modified (grade)"]])
    csv_tables.write_csv(out / "moodle_worksheet.csv", WORKSHEET_COLUMNS, lines, private=True)
    jobs.write_private_file(out / "moodle_feedback.zip", make_zip(feedback_files))
    return notes


def _check_line(worksheet: Path, line: dict[str, str], homework: Homework) -> None:
    """Raise InputError for a line that is not of the worksheet of this homework."""
    for column in REQUIRED_COLUMNS:
        if column not in line:
            raise InputError(
                f"{worksheet}: expected a Moodle grading worksheet in English, "
                f"but it has no column {column!r}"
            )
    max_grade = line["maximum grade"]
    if max_grade and float(max_grade) != homework.points:
        raise InputError(
            f"{worksheet}: expected a maximum grade of {homework.points:g} points, as "
            f"{homework.name} gives, got {max_grade}; set it in the assignment"
        )


def _find_row(line: dict[str, str], rows_by_name: dict[str, GradebookRow]) -> GradebookRow | None:
    """Return the row of the student in a line of the worksheet, or None for an unknown one."""
    for column in ID_COLUMNS:
        row = rows_by_name.get(fold(line.get(column, "")))
        if row is not None:
            return row
    return None
