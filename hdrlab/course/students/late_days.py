"""Late days: each student has some free late days for the term, then each extra day costs points.

A project that is received after its due date is late by a number of days; each day that has begun
counts as a whole day. Free late days are used in the order of the due dates, as long as they last.
Each further day costs a number of points, but a project never costs more than it is worth.

If a team is late, each member is charged the same number of days, but pays with their own free
days. So a student's grade never depends on the free days that a partner used elsewhere.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timedelta

from hdrlab.errors import InputError

FREE_LATE_DAYS = 10
POINTS_PER_DAY = 1.0
ONE_DAY = timedelta(days=1)
WHAT_IF_DAYS = range(15)


@dataclass(frozen=True)
class LateRecord:
    """A project that was handed in: how many days late, by which students, and its points."""

    project: str
    late: int
    students: tuple[str, ...]
    points: float


@dataclass(frozen=True)
class LateDayCharge:
    """What the late days of a project cost one of its students.

    Attributes
    ----------
    student, project : who, and for what
    late : days after the due date
    excused : those of the days that are free
    penalty : points taken off for the others
    score : the points that remain
    left : the free days that the student still has afterwards
    """

    student: str
    project: str
    late: int
    excused: int
    penalty: float
    score: float
    left: int


def days_late(due: datetime, received: datetime) -> int:
    """Return how many days late a project is: ceil((received - due) / 1 day), or 0.

    Both times must have a time zone: students may be in several zones, and clocks change in
    autumn.

    Examples
    --------
    >>> due = datetime.fromisoformat("2026-03-20T23:59+08:00")
    >>> [days_late(due, due + timedelta(minutes=m)) for m in (0, 1, 24 * 60, 24 * 60 + 1)]
    [0, 1, 1, 2]
    """
    if due.tzinfo is None or received.tzinfo is None:
        raise InputError(
            f"expected times with a time zone, such as 2026-03-20T23:59+08:00, "
            f"got {due}, {received}"
        )
    whole_days_rounded_up = -((due - received) // ONE_DAY)
    return max(0, whole_days_rounded_up)


def late_penalty(
    late: int, left: int, points: float, *, per_day: float = POINTS_PER_DAY
) -> tuple[int, float]:
    """Return how many late days are free, and how many points the others cost.

    These are min(late, left) and min(points, per_day (late - excused)).

    Examples
    --------
    >>> late_penalty(4, left=1, points=100), late_penalty(200, left=0, points=90.0)
    ((1, 3.0), (0, 90.0))
    """
    excused = min(late, left)
    penalty = min(max(points, 0.0), per_day * (late - excused))
    return excused, penalty


def charge_late_days(
    records: Iterable[LateRecord],
    *,
    grace: int = FREE_LATE_DAYS,
    per_day: float = POINTS_PER_DAY,
) -> Iterator[LateDayCharge]:
    """Yield what the late days of each project cost each of its students.

    Parameters
    ----------
    records : in the order of the due dates; teams may differ from one project to the next
    grace : free late days of each student for the term
    per_day : points for each further day

    Raises
    ------
    InputError
        For a negative number of days or points, or a student who handed in a project twice.
    """
    if grace < 0 or per_day < 0:
        raise InputError(
            f"expected free days and points a day of at least 0, got {grace} and {per_day}"
        )
    days_left: dict[str, int] = {}
    seen: set[tuple[str, str]] = set()
    for record in records:
        if record.late < 0:
            raise InputError(
                f"{record.project}: expected late days of at least 0, got {record.late}"
            )
        for student in record.students:
            if (student, record.project) in seen:
                raise InputError(f"{record.project}: expected {student} once, got it twice")
            seen.add((student, record.project))
            left_before = days_left.get(student, grace)
            excused, penalty = late_penalty(
                record.late, left_before, record.points, per_day=per_day
            )
            days_left[student] = left_before - excused
            yield LateDayCharge(
                student=student,
                project=record.project,
                late=record.late,
                excused=excused,
                penalty=penalty,
                score=record.points - penalty,
                left=days_left[student],
            )


def what_if(
    records: Sequence[LateRecord],
    project: str,
    days: Iterable[int] = WHAT_IF_DAYS,
    *,
    grace: int = FREE_LATE_DAYS,
    per_day: float = POINTS_PER_DAY,
) -> list[tuple[int, dict[str, LateDayCharge]]]:
    """Return what a project would cost each student if it were 0, 1, 2, ... days late.

    Parameters
    ----------
    records, grace, per_day : see `charge_late_days`
    project : the name of the project
    days : the numbers of days to try

    Returns
    -------
    list of (days, dict)
        For each number of days, the charge of each student by name.

    Examples
    --------
    >>> before = [LateRecord("hw1", 8, ("b1",), 100), LateRecord("project", 0, ("b1", "b2"), 90)]
    >>> for late, charges in what_if(before, "project", (0, 2, 5)):
    ...     print(late, {student: (row.penalty, row.left) for student, row in charges.items()})
    0 {'b1': (0.0, 2), 'b2': (0.0, 10)}
    2 {'b1': (0.0, 0), 'b2': (0.0, 8)}
    5 {'b1': (3.0, 0), 'b2': (0.0, 5)}
    """
    if project not in {record.project for record in records}:
        raise InputError(f"expected a project that was handed in, got {project!r}")
    table = []
    for late in days:
        supposed = [
            replace(record, late=late) if record.project == project else record
            for record in records
        ]
        charges = charge_late_days(supposed, grace=grace, per_day=per_day)
        table.append(
            (late, {charge.student: charge for charge in charges if charge.project == project})
        )
    return table
