"""Score functions with a task's specification: those of the library, wrong answers, and other
solutions.
"""

import inspect
import runpy
from fractions import Fraction
from functools import cache
from importlib import import_module

import numpy as np
import pytest

from hdrlab.course import plan
from hdrlab.course.checks import SPECIFICATION, misconceptions, plugin
from hdrlab.course.grading import scoring
from hdrlab.course.grading.results import Check
from hdrlab.course.variants import rewording

PLAN = plan.read()


def functions(path):
    """Return the functions of a file by name."""
    return {
        name: value
        for name, value in runpy.run_path(str(path)).items()
        if inspect.isfunction(value)
    }


@cache
def module(task, variant=""):
    """Import the file with the checks of a task, adapted to a variant."""
    if not variant:
        return vars(import_module(f"hdrlab.course.checks.specification.test_{task}"))
    text = (SPECIFICATION / f"test_{task}.py").read_text(encoding="utf8")
    scope = {"__name__": f"test_{task}"}
    exec(rewording.reword(task, variant, text), scope)
    return scope


def checks(task, variant=""):
    """Return the checks of a task: (name, function, points, hints, the name of the check that it needs)."""
    checks_found = []
    for name, check in module(task, variant).items():
        if name.startswith("test_"):
            (mark,) = getattr(check, "pytestmark", [pytest.mark.points(1).mark])
            checks_found.append(
                (name, check, mark.args[0], plugin.hints(check), mark.kwargs.get("needs") or None)
            )
    return checks_found


def ask(check, subject, seed=0):
    """Return the error that a check raises for a subject, or None if it holds."""
    parameters = inspect.signature(check).parameters
    arguments = {"subject": subject, "rng": np.random.default_rng(seed)}
    try:
        check(**{name: arguments[name] for name in parameters})
    except Exception as error:  # whatever a student's code raises costs that promise, and no other
        return error
    return None


def answered(task, subject, seed=0, variant=""):
    """Return the error of each check of a task by its name, or None for a check that passes."""
    return answered_and_asked(task, subject, seed, variant)[0]


def answered_and_asked(task, subject, seed=0, variant=""):
    """Return the error of each check of a task by its name, and the calls that each check made."""
    outcomes = {}
    calls_of_checks = []
    for name, check, *_ in checks(task, variant):
        before = len(subject.calls)
        outcomes[name] = ask(check, subject, seed)
        calls = subject.calls[before:]
        calls_of_checks.append(
            misconceptions.CheckedCalls(calls=calls, holds=outcomes[name] is None)
        )
    return outcomes, calls_of_checks


def score(task, subject, seed=0, variant=""):
    """Return the fraction of a task's points that a subject gets, and the error of each check.

    As in grading, a known mistake that explains all answers costs at most half of the points.
    """
    outcomes, calls = answered_and_asked(task, subject, seed, variant)
    diagnosis = misconceptions.Diagnosis()
    if any(outcomes.values()):
        diagnosis = misconceptions.diagnose(PLAN.task(task)._replace(variant=variant), calls)
    worth = [Fraction(str(points)) for _, _, points, *_ in checks(task, variant)]
    checks_of_task = [
        Check(task, name, name, Fraction(), points, "fails" if outcomes[name] else "holds")
        for (name, *_), points in zip(checks(task, variant), worth, strict=True)
    ]
    needs = {name: needs or "" for name, *_, needs in checks(task, variant)}
    traced = scoring.attribute_failures(
        checks_of_task, needs, named=diagnosis.explains_all, once=diagnosis.costs_half_at_most
    )
    return float(sum(check.points for check in traced) / sum(worth)), outcomes
