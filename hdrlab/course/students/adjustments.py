"""Read an instructor's own decisions about students: more time, points by hand, comments, held grades.

The table is a CSV file with the column `student`, which holds ids or the codes of anonymous
grading, and any of these:

extension   days by which the due date moves for this student
points      added to the score by hand, such as for a report or as extra credit; may be negative
comment     a sentence to the student
hold        "yes" keeps the score out of the tables for Canvas and Moodle
"""

import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from hdrlab.course.sanitize import sanitize_line
from hdrlab.course.students import csv_tables
from hdrlab.course.students.roster import Roster
from hdrlab.errors import InputError

COLUMNS = ("student", "extension", "points", "comment", "hold")
HOLD_WORDS = {"": False, "no": False, "yes": True}
MAX_EXTENSION_DAYS = 365
MAX_COMMENT_LENGTH = 1000


class Adjustment(NamedTuple):
    """What an instructor decided about a student's homework.

    Attributes
    ----------
    extension : days by which the due date moves
    points : added to the score
    comment : a sentence to the student, or ""
    hold : whether the score is not published yet
    """

    extension: int = 0
    points: float = 0.0
    comment: str = ""
    hold: bool = False


def read(
    path: Path, roster: Roster, ids_by_code: Mapping[str, str] = MappingProxyType({})
) -> dict[str, Adjustment]:
    """Read a table of adjustments, by the students' ids.

    Parameters
    ----------
    path : the table
    roster : the class
    ids_by_code : the students of the codes that an anonymous reader writes instead of ids

    Raises
    ------
    InputError
        For an unknown column or student, a student with two rows, and a value of another kind; the
        message has the file, the line and the column.
    """
    adjustments: dict[str, Adjustment] = {}
    for line, row in enumerate(csv_tables.read_csv(path), 2):
        unknown = sorted(set(row) - set(COLUMNS))
        if unknown or "student" not in row:
            raise InputError(
                f"{path}: expected the column student and any of {', '.join(COLUMNS[1:])}, "
                f"got {', '.join(row)}"
            )
        try:
            name = csv_tables.unescape_cell(row["student"])
            student = roster.find(ids_by_code.get(name, name)).id
            if student in adjustments:
                raise InputError(f"expected each student once, got {student} twice")
            adjustments[student] = _read_row(row)
        except InputError as error:
            raise InputError(f"{path}, line {line}: {error}") from None
    return adjustments


def merge(tables: Iterable[Mapping[str, Adjustment]]) -> dict[str, Adjustment]:
    """Return the adjustments of several tables together, by the students' ids.

    Extensions and points add up, comments follow each other, and a score is held back if any table
    says so.
    """
    merged: dict[str, Adjustment] = {}
    for table in tables:
        for student, adjustment in table.items():
            before = merged.get(student, Adjustment())
            comments = [comment for comment in (before.comment, adjustment.comment) if comment]
            merged[student] = Adjustment(
                extension=before.extension + adjustment.extension,
                points=before.points + adjustment.points,
                comment=" ".join(comments),
                hold=before.hold or adjustment.hold,
            )
    return merged


def _read_row(row: dict[str, str]) -> Adjustment:
    """Return the adjustment of a row; raise an InputError that names the column."""
    extension = _read_number(row, "extension")
    if extension != int(extension) or not 0 <= extension <= MAX_EXTENSION_DAYS:
        raise InputError(
            f"expected 0 to {MAX_EXTENSION_DAYS} whole days in the column 'extension', "
            f"got {row['extension']!r}"
        )
    hold = row.get("hold", "").casefold()
    if hold not in HOLD_WORDS:
        raise InputError(f"expected yes or no in the column 'hold', got {row['hold']!r}")
    return Adjustment(
        extension=int(extension),
        points=_read_number(row, "points"),
        comment=sanitize_line(row.get("comment", ""), MAX_COMMENT_LENGTH),
        hold=HOLD_WORDS[hold],
    )


def _read_number(row: dict[str, str], column: str) -> float:
    """Return the number in a column, with a decimal point or comma; 0 if there is none."""
    text = row.get(column, "")
    try:
        number = float(text.replace(",", ".") or 0)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise InputError(f"expected a number in the column {column!r}, got {text!r}")
    return number
