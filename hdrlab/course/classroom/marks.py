"""From results to a gradebook: what each student of a team earned, and what being late took off.

A row of the gradebook holds what the next homework's needs, so gradebooks add up over a term.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from hdrlab.course.classroom.handins import Submission
from hdrlab.course.classroom.late import (
    LateDayCharge,
    LateRecord,
    accounts,
    lateness,
    what_if as late_days,
)
from hdrlab.course.classroom.run import GradingContext
from hdrlab.course.plan import Homework
from hdrlab.course.reports import csv_tables
from hdrlab.errors import InputError

NOT_GRADED = "not graded"
LARGE = 1 << 27  # bytes of a gradebook: of a class of any size
DAYS = range(15)  # of the what-if table


class GradebookRow(NamedTuple):
    """A student's row: `work` are the points before the penalty, `score` those after it."""

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
    score: float
    left: int
    note: str = ""


COLUMNS = (*GradebookRow._fields[:-2], "grace left", "note")


def marks(
    course: GradingContext,
    handins: Mapping[str, Submission],
    points: Mapping[str, float],
    remarks: Mapping[str, str] = MappingProxyType({}),
) -> list[GradebookRow]:
    """Return a row for each student of the roster.

    Parameters
    ----------
    course : of whom, of what, and by which rule for what comes late
    handins : what counts of each team
    points : of the work, by team; a team without is noted
    remarks : by team, why a file was refused, or what else stands in its note
    """
    homework, late = course.homework, course.late
    handed = [*course.before]
    for team, one in handins.items():
        days = lateness(homework.due, one.received)
        handed.append(LateRecord(homework.name, days, one.students, points.get(team, 0.0)))
    bills = list(accounts(handed, grace=late.free_days, per_day=late.points_a_day))
    left = {bill.student: bill.left for bill in bills}
    mine, rows = {bill.student: bill for bill in bills if bill.project == homework.name}, []
    for id, name, team, _ in course.roster.students:
        bill = mine.get(
            id, LateDayCharge(id, homework.name, 0, 0, 0.0, 0.0, left.get(id, late.free_days))
        )
        received, work, notes = "", 0.0, ["not handed in"]
        if id in mine:
            received, work = (
                handins[team].received.isoformat(timespec="minutes"),
                points.get(team, 0.0),
            )
            notes = ["" if team in points else NOT_GRADED, handins[team].note]
        note = "; ".join(filter(None, (*notes, remarks.get(team, ""))))
        earned = (work, homework.points, bill.penalty, bill.score, bill.left, note)
        rows.append(
            GradebookRow(id, name, team, homework.name, received, bill.late, bill.excused, *earned)
        )
    return rows


def what_if(
    course: GradingContext, points: Mapping[str, float]
) -> tuple[list[str], list[list[csv_tables.Cell]]]:
    """Return header and rows of a table: each student's score, had the work come so many days late.

    Work that has not come, or is not graded, is taken for one that earns all points. The parameters
    are those of `marks`.
    """
    homework, late = course.homework, course.late
    teams = {
        team: tuple(one.id for one in members) for team, members in course.roster.teams().items()
    }
    work = {team: points.get(team, homework.points) for team in teams}
    supposed = [
        LateRecord(homework.name, 0, members, work[team]) for team, members in teams.items()
    ]
    handed = [*course.before, *supposed]
    table = late_days(handed, homework.name, DAYS, grace=late.free_days, per_day=late.points_a_day)
    header = ["student", "name", "team", "homework", "work", *(f"late {days}" for days in DAYS)]
    rows: list[list[csv_tables.Cell]] = [
        [
            one.id,
            one.name,
            one.team,
            homework.name,
            work[one.team],
            *(by[one.id].score for _, by in table),
        ]
        for one in course.roster.students
    ]
    return header, rows


def read(paths: Sequence[Path]) -> list[LateRecord]:
    """Return what gradebooks of earlier homeworks tell, in the order of the files."""
    handed = []
    for path in paths:
        for row in csv_tables.read_csv(path, max_bytes=LARGE):
            try:
                if row["received"] and not row["note"].startswith(NOT_GRADED):
                    student = (row["student"].removeprefix("'"),)
                    handed.append(
                        LateRecord(row["homework"], int(row["late"]), student, float(row["work"]))
                    )
            except (KeyError, ValueError):
                raise InputError(
                    f"{path}: expected a gradebook that `hdrlab grade` has written"
                ) from None
    return handed


def canvas(
    rows: Sequence[GradebookRow], homework: Homework
) -> tuple[list[str], list[list[csv_tables.Cell]]]:
    """Return header and rows of the table that Canvas imports: the second line holds the points possible."""
    title = f"{homework.name}: {homework.title}"
    header = ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", title]
    possible: list[csv_tables.Cell] = ["    Points Possible", "", "", "", "", homework.points]
    lines: list[list[csv_tables.Cell]] = [
        [one.name, "", one.student, one.student, "", one.score] for one in rows
    ]
    return header, [possible, *lines]
