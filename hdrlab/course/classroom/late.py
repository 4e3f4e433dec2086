"""Late days: so many in all without penalty, then a point a day, down to zero for each project.

late     days by which a project came after its time, each one begun counted whole
grace    days without penalty, for the whole term: 10, unless the course says otherwise
points   what the project's work is worth before the penalty; the penalty takes it to zero and no further

Days of grace are spent in the order in which the projects were due, as far as they last. A team's
late day is a late day of each member, and each pays with their own days: nobody's grade hangs on
what the partner has spent before, or will spend in another team, and nobody's days are spent for
somebody else.
"""

from collections.abc import Iterable, Iterator, Sequence
from datetime import datetime, timedelta
from typing import Any, NamedTuple

from hdrlab.errors import InputError

GRACE = 10
DAY = timedelta(days=1)


class LateRecord(NamedTuple):
    """A project as it came in: how late, by whom, and the points of the work."""

    project: str
    late: int
    students: tuple[str, ...]
    points: float


class LateDayCharge(NamedTuple):
    """What a student's late days came to in one project; `left` is the grace that remains after it."""

    student: str
    project: str
    late: int
    excused: int
    penalty: float
    score: float
    left: int


def lateness(due: datetime, received: datetime) -> int:
    """Return late = ceil((received - due) / 1 day), or 0.

    Both times name their zone: a class is spread over more than one, and the clocks change in
    autumn.

    Examples
    --------
    >>> due = datetime.fromisoformat("2026-03-20T23:59+08:00")
    >>> [lateness(due, due + timedelta(minutes=m)) for m in (0, 1, 24 * 60, 24 * 60 + 1)]
    [0, 1, 1, 2]
    """
    if due.tzinfo is None or received.tzinfo is None:
        raise InputError(
            f"expected times with a zone, such as 2026-03-20T23:59+08:00, got {due}, {received}"
        )
    return max(0, -((due - received) // DAY))


def penalty(late: int, left: int, points: float, *, per_day: float = 1.0) -> tuple[int, float]:
    """Return the days that grace excuses, min(late, left), and min(points, per_day (late - excused)).

    Examples
    --------
    >>> penalty(4, left=1, points=100), penalty(200, left=0, points=90.0)
    ((1, 3.0), (0, 90.0))
    """
    excused = min(late, left)
    return excused, min(max(points, 0.0), per_day * (late - excused))


def accounts(
    handed: Iterable[LateRecord], *, grace: int = GRACE, per_day: float = 1.0
) -> Iterator[LateDayCharge]:
    """Yield what each project costs each of its students, with the projects in the order they were due.

    Parameters
    ----------
    handed : the projects, in the order they were due; teams may differ from one to the next
    grace : days without penalty for each student, in all
    per_day : points for each day beyond them

    Raises
    ------
    ValueError
        For days below zero, a team that names a student twice, or a project handed in twice by a
        student.
    """
    if grace < 0 or per_day < 0:
        raise InputError(
            f"expected grace and points a day of at least 0, got {grace} and {per_day}"
        )
    left: dict[str, int] = {}
    seen: set[tuple[str, str]] = set()
    for project, late, students, points in handed:
        if late < 0:
            raise InputError(f"{project}: expected late days of at least 0, got {late}")
        for student in students:
            if (student, project) in seen:
                raise InputError(f"{project}: expected {student} once, got it twice")
            seen.add((student, project))
            before = left.get(student, grace)
            excused, lost = penalty(late, before, points, per_day=per_day)
            left[student] = before - excused
            yield LateDayCharge(student, project, late, excused, lost, points - lost, left[student])


def what_if(
    handed: Sequence[LateRecord], project: str, days: Iterable[int] = range(15), **terms: Any
) -> list[tuple[int, dict[str, LateDayCharge]]]:
    """Return what `project` would cost each of its students were it so many days late, and else all as it is.

    `terms` are those of `accounts`.

    Examples
    --------
    >>> before = [Handed("hw1", 8, ("b1",), 100), Handed("project", 0, ("b1", "b2"), 90)]
    >>> for late, rows in what_if(before, "project", (0, 2, 5)):
    ...     print(late, {student: (row.penalty, row.left) for student, row in rows.items()})
    0 {'b1': (0.0, 2), 'b2': (0.0, 10)}
    2 {'b1': (0.0, 0), 'b2': (0.0, 8)}
    5 {'b1': (3.0, 0), 'b2': (0.0, 5)}
    """
    if project not in {one.project for one in handed}:
        raise InputError(f"expected a project that was handed in, got {project!r}")
    table = []
    for late in days:
        supposed = [one._replace(late=late) if one.project == project else one for one in handed]
        rows = accounts(supposed, **terms)
        table.append((late, {row.student: row for row in rows if row.project == project}))
    return table
