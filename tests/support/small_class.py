"""A class of three students in two teams, a homework with one task, and results of grading it."""

from dataclasses import replace
from datetime import UTC, datetime
from fractions import Fraction

from hdrlab.course.grading.results import Check, Result
from hdrlab.course.plan import Homework, Task
from hdrlab.course.students.roster import Roster, Student

NOON = datetime(2026, 3, 1, 12, tzinfo=UTC)
HOMEWORK = Homework("hw2", "Curves", NOON, (Task("a", "b.a", 10.0),))
ROSTER = Roster(
    (Student("b1", "Ada", "t", "a@x"), Student("b2", "Bo", "t"), Student("b3", "Cy", "b3"))
)


def make_result(student="t", *kinds, problems=(), **fields):
    """Return a Result with one check for each kind of missing answer; the kind "" is a passed check.

    Parameters
    ----------
    kinds : such as "late" or "died"; without any, the result has one passed check
    problems : the problems of the submission
    fields : fields of the Result to replace
    """
    checks = []
    for number, kind in enumerate(kinds or ("",)):
        check = Check(
            "a",
            f"c{number}",
            f"P{number}",
            Fraction(0 if kind else 1),
            Fraction(1),
            "no answer" if kind else "holds",
            kind=kind,
        )
        checks.append(check)
    made = Result(
        student, "hw2", "", "strict", tuple(checks), {}, tuple(problems), "", "", "seed", {}
    )
    return replace(made, **fields)
