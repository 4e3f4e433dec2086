"""Moodle: a table for its gradebook, its own grading worksheet filled in, and an archive of the feedback.

The gradebook takes any table whose columns are then mapped [Moodle Docs, Grade import]. An
assignment knows students by numbers of its own, which stand in the worksheet that it gives out: so
worksheet and archive of feedback files are made from that file [Moodle Docs, Using Assignment; the
archive's names as in assignfeedback_file_zip_importer]. An import without a column of comments
leaves a teacher's comments alone.
"""

import re
from collections.abc import Sequence
from pathlib import Path

from hdrlab.course.archives.packing import packed
from hdrlab.course.classroom import jobs
from hdrlab.course.classroom.marks import NOT_GRADED, GradebookRow
from hdrlab.course.classroom.roster import Roster, fold
from hdrlab.course.plan import Homework
from hdrlab.course.reports import csv_tables
from hdrlab.errors import InputError

WHO = ("id number", "username", "email address")  # columns of a worksheet that may say who it is
NEEDED = ("identifier", "grade", "maximum grade", "last modified (grade)")
COLUMNS = ("Identifier", "Full name", "Grade", "Last modified (grade)")
FEEDBACK = "Participant_{}_assignsubmission_file_feedback.html"


def gradebook(
    rows: Sequence[GradebookRow], roster: Roster, homework: Homework
) -> tuple[list[str], list[list[csv_tables.Cell]]]:
    """Return header and rows of the table that Moodle's gradebook imports."""
    header = ["ID number", "Username", "Email address", f"{homework.name}: {homework.title}"]
    emails = {one.id: one.email for one in roster.students}
    return header, [[row.student, row.student, emails[row.student], row.score] for row in rows]


def write(
    out: Path, worksheet: Path, rows: Sequence[GradebookRow], roster: Roster, homework: Homework
) -> list[str]:
    """Write moodle_worksheet.csv and moodle_feedback.zip, and return notes on whom the roster does not know.

    A participant whose work has not been graded keeps the grade that the worksheet has.

    Raises
    ------
    ValueError
        For another table, and where the assignment gives another number of points than the
        homework.
    """
    listed, both = (
        csv_tables.read_csv(worksheet, max_bytes=1 << 27),
        zip(rows, roster.students, strict=True),
    )
    known = {fold(word): row for row, one in both for word in (one.id, one.email) if word}
    lines: list[list[csv_tables.Cell]] = []
    files, lost = {}, []
    for line in listed:
        if missing := [name for name in NEEDED if name not in line]:
            raise InputError(
                f"{worksheet}: expected Moodle's worksheet in English, got no {missing[0]!r}"
            )
        if line["maximum grade"] and float(line["maximum grade"]) != homework.points:
            points = (
                f"{homework.points:g} points as {homework.name} gives, got {line['maximum grade']}"
            )
            raise InputError(
                f"{worksheet}: expected a maximum grade of {points}; set it in the assignment"
            )
        row = next(
            (known[fold(line[name])] for name in WHO if fold(line.get(name, "")) in known), None
        )
        grade: csv_tables.Cell = line["grade"]
        if row is None:
            lost.append(
                f"{worksheet.name}: the roster knows nobody of {line.get('full name', '')!r}"
            )
        elif row.received and not row.note.startswith(NOT_GRADED):
            grade, page = row.score, out / "feedback" / row.team / "feedback.html"
            (number,) = re.findall(r"\d+$", line["identifier"]) or [""]
            if number and page.is_file():
                files[FEEDBACK.format(number)] = page.read_bytes()
        lines.append(
            [line["identifier"], line.get("full name", ""), grade, line["last modified (grade)"]]
        )
    csv_tables.write_csv(out / "moodle_worksheet.csv", COLUMNS, lines, private=True)
    jobs.write_private_file(out / "moodle_feedback.zip", packed(files))
    return lost
