"""A class of three students in two teams, its homework of one task, and results of it."""

from dataclasses import replace
from datetime import UTC, datetime
from fractions import Fraction

from hdrlab.course.grading.results import Check, Result
from hdrlab.course.plan import Homework, Task
from hdrlab.course.students.roster import Roster, Student

NOON = datetime(2026, 3, 1, 12, tzinfo=UTC)
HOMEWORK = Homework("hw2", "Curves", NOON, (Task("a", "b.a", 10.0),))
CLASS = Roster(
    (Student("b1", "Ada", "t", "a@x"), Student("b2", "Bo", "t"), Student("b3", "Cy", "b3"))
)


def result(student="t", *kinds, problems=(), **more):
    """A Result with a check for each kind of answer."""
    checks = [
        Check(
            "a",
            f"c{k}",
            f"P{k}",
            Fraction(not kind),
            Fraction(1),
            "no answer" if kind else "holds",
            kind=kind,
        )
        for k, kind in enumerate(kinds or ("",))
    ]
    made = Result(
        student, "hw2", "", "strict", tuple(checks), {}, tuple(problems), "", "", "seed", {}
    )
    return replace(made, **more)
