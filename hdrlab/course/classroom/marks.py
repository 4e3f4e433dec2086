"""The gradebook: each student's points, late days, penalty and score.

A gradebook holds what the gradebook of the next homework needs, so that late days add up over a
term.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from datetime import datetime
from pathlib import Path
from types import MappingProxyType

from hdrlab.course.classroom.run import GradingContext
from hdrlab.course.plan import Homework
from hdrlab.course.students import csv_tables
from hdrlab.course.students.adjustments import Adjustment
from hdrlab.course.students.late_days import (
    WHAT_IF_DAYS,
    LateDayCharge,
    LateRecord,
    charge_late_days,
    days_late,
    what_if as late_days_what_if,
)
from hdrlab.course.submissions.class_folder import Submission
from hdrlab.errors import InputError

NOT_GRADED = "not graded"
NOT_HANDED_IN = "not handed in"
MAX_LATE_SHOWN = 10  # students who are named before grading
MAX_GRADEBOOK_BYTES = 128 * 2**20  # enough for a class of any size


@dataclass(frozen=True)
class GradebookRow:
    """The row of a student.

    Attributes
    ----------
    student, name, team, homework : who, and for what
    received : when the submission was received, or "" without one
    late, excused : late days, and those of them that are free
    work : points before the penalty
    of : points that the homework can give
    penalty : points taken off for late days
    by_hand : points that the instructor added
    score : points after the penalty, with those by hand
    left : free late days that remain
    note : what went wrong, if anything
    comment : the instructor's sentence to the student
    hold : whether the score is not published yet
    """

    student: str
    name: str
    team: str
    homework: str
    received: str
    late: int
    excused: int
    work: float
    of: float
    penalty: float
    by_hand: float
    score: float
    left: int
    note: str = ""
    comment: str = ""
    hold: bool = False

    @property
    def cells(self) -> list[csv_tables.Cell]:
        """The row as it is written to gradebook.csv, in the order of `COLUMNS`."""
        cells: list[csv_tables.Cell] = [getattr(self, field.name) for field in fields(self)]
        return [*cells[:-1], "yes" if self.hold else ""]


# As the fields of GradebookRow, in words.
COLUMNS = (
    "student",
    "name",
    "team",
    "homework",
    "received",
    "late",
    "excused",
    "work",
    "of",
    "penalty",
    "by hand",
    "score",
    "grace left",
    "note",
    "comment",
    "hold",
)


def gradebook_rows(
    context: GradingContext,
    submissions: Mapping[str, Submission],
    points: Mapping[str, float],
    remarks: Mapping[str, str] = MappingProxyType({}),
) -> list[GradebookRow]:
    """Return a row for each student of the roster.

    Parameters
    ----------
    context : the roster, the homework and the rule for late submissions
    submissions : by team
    points : of the work, by team; a team without points is noted as not graded
    remarks : more for the notes, by team, such as why a file was refused
    """
    homework = context.homework
    records = [*context.before, *_late_records(context, submissions, points)]
    charges = list(
        charge_late_days(records, grace=context.late.free_days, per_day=context.late.points_a_day)
    )
    days_left = {charge.student: charge.left for charge in charges}
    homework_charges = {
        charge.student: charge for charge in charges if charge.project == homework.name
    }
    rows = []
    for student in context.roster.students:
        charge = homework_charges.get(student.id)
        if charge is None:
            charge = LateDayCharge(
                student=student.id,
                project=homework.name,
                late=0,
                excused=0,
                penalty=0.0,
                score=0.0,
                left=days_left.get(student.id, context.late.free_days),
            )
            received = ""
            notes = [NOT_HANDED_IN]
            work = 0.0
        else:
            submission = submissions[student.team]
            received = submission.received.isoformat(timespec="minutes")
            notes = ["" if student.team in points else NOT_GRADED, submission.note]
            work = points.get(student.team, 0.0)
        notes.append(remarks.get(student.team, ""))
        adjustment = context.adjustments.get(student.id, Adjustment())
        if adjustment.extension:
            notes.append(f"extension of {_count(adjustment.extension, 'day')}")
        rows.append(
            GradebookRow(
                student=student.id,
                name=student.name,
                team=student.team,
                homework=homework.name,
                received=received,
                late=charge.late,
                excused=charge.excused,
                work=work,
                of=homework.points,
                penalty=charge.penalty,
                by_hand=adjustment.points,
                score=max(0.0, charge.score + adjustment.points),
                left=charge.left,
                note="; ".join(note for note in notes if note),
                comment=adjustment.comment,
                hold=adjustment.hold,
            )
        )
    return rows


def _late_records(
    context: GradingContext, submissions: Mapping[str, Submission], points: Mapping[str, float]
) -> Iterator[LateRecord]:
    """Yield how late each student of a submission is, after the student's own extension."""
    homework = context.homework
    for team, submission in submissions.items():
        days = 0
        if submission.can_be_late and isinstance(homework.due, datetime):
            days = days_late(homework.due, submission.received)
        for student in submission.students:
            adjustment = context.adjustments.get(student, Adjustment())
            late = max(0, days - adjustment.extension)
            yield LateRecord(homework.name, late, (student,), points.get(team, 0.0))


def describe_late(
    context: GradingContext,
    submissions: Mapping[str, Submission],
    codes: Mapping[str, str] = MappingProxyType({}),
) -> str:
    """Return who is late, by how many days, and what it costs at most; "" if nobody is.

    With codes, by student, they are shown instead of the ids, and in their order.
    """
    full_points = dict.fromkeys(submissions, context.homework.points)
    rows = gradebook_rows(context, submissions, full_points)
    if codes:
        rows = [replace(row, student=codes[row.student]) for row in rows]
        rows.sort(key=lambda row: row.student)
    late = [row for row in rows if row.late]
    if not late:
        return ""
    described = [
        f"{row.student} {_count(row.late, 'day')} ({row.excused} free, "
        f"{_count(row.penalty, 'point')} off)"
        for row in late[:MAX_LATE_SHOWN]
    ]
    if len(late) > MAX_LATE_SHOWN:
        described.append(f"and {len(late) - MAX_LATE_SHOWN} more")
    return f"{len(late)} of {len(rows)} students are late: {', '.join(described)}"


def _count(number: float, what: str) -> str:
    return f"{number:g} {what}" if number == 1 else f"{number:g} {what}s"


def what_if_table(
    context: GradingContext, points: Mapping[str, float]
) -> tuple[list[str], list[list[csv_tables.Cell]]]:
    """Return header and rows of a table with each student's score for 0, 1, 2, ... days late.

    A team that has not handed in, or is not graded, is shown with all points.
    """
    homework = context.homework
    teams = context.roster.teams()
    team_points = {team: points.get(team, homework.points) for team in teams}
    supposed = [
        LateRecord(homework.name, 0, tuple(student.id for student in members), team_points[team])
        for team, members in teams.items()
    ]
    table = late_days_what_if(
        [*context.before, *supposed],
        homework.name,
        WHAT_IF_DAYS,
        grace=context.late.free_days,
        per_day=context.late.points_a_day,
    )
    header = ["student", "name", "team", "homework", "work"]
    header.extend(f"late {days}" for days in WHAT_IF_DAYS)
    rows = []
    for student in context.roster.students:
        row: list[csv_tables.Cell] = [
            student.id,
            student.name,
            student.team,
            homework.name,
            team_points[student.team],
        ]
        row.extend(charges[student.id].score for _, charges in table)
        rows.append(row)
    return header, rows


def read(paths: Sequence[Path]) -> list[LateRecord]:
    """Read the late records of earlier homeworks from their gradebooks, in the order of the files.

    Raises
    ------
    InputError
        For a file that is no gradebook.
    """
    records = []
    for path in paths:
        for row in csv_tables.read_csv(path, max_bytes=MAX_GRADEBOOK_BYTES):
            try:
                if not row["received"] or row["note"].startswith(NOT_GRADED):
                    continue
                student = csv_tables.unescape_cell(row["student"])
                late = int(row["late"])
                points = float(row["work"])
                records.append(LateRecord(row["homework"], late, (student,), points))
            except (KeyError, ValueError):
                raise InputError(
                    f"{path}: expected a gradebook that `hdrlab grade` has written"
                ) from None
    return records


def canvas_table(
    rows: Sequence[GradebookRow], homework: Homework
) -> tuple[list[str], list[list[csv_tables.Cell]]]:
    """Return header and rows of the table that Canvas imports.

    The first row holds the points that are possible. A score that is held back is left empty.
    """
    title = f"{homework.name}: {homework.title}"
    header = ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", title]
    table: list[list[csv_tables.Cell]] = [["    Points Possible", "", "", "", "", homework.points]]
    table.extend(
        [row.name, "", row.student, row.student, "", None if row.hold else row.score]
        for row in rows
    )
    return header, table
