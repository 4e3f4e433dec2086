"""The points of a task's specification, for functions to trust: the library's, wrong files, other ways."""

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
    """Return the functions of a file by their names."""
    return {name: one for name, one in runpy.run_path(str(path)).items() if inspect.isfunction(one)}


@cache
def module(task, variant=""):
    """Return what stands in the file with the checks of a task, in the words of a variant."""
    if not variant:
        return vars(import_module(f"hdrlab.course.checks.specification.test_{task}"))
    text = (SPECIFICATION / f"test_{task}.py").read_text(encoding="utf8")
    scope = {"__name__": f"test_{task}"}
    exec(rewording.reword(task, variant, text), scope)
    return scope


def checks(task, variant=""):
    """Return the checks of a task: (name, function, points, hints, the name of the check that it needs)."""
    found = []
    for name, check in module(task, variant).items():
        if name.startswith("test_"):
            (mark,) = getattr(check, "pytestmark", [pytest.mark.points(1).mark])
            found.append(
                (name, check, mark.args[0], plugin.hints(check), mark.kwargs.get("needs") or None)
            )
    return found


def ask(check, subject, seed=0):
    """Return the error that a check raises for a subject, or None if it holds."""
    wanted = inspect.signature(check).parameters
    given = {"subject": subject, "rng": np.random.default_rng(seed)}
    try:
        check(**{one: given[one] for one in wanted})
    except Exception as error:  # whatever a student's code raises costs that promise, and no other
        return error
    return None


def answered(task, subject, seed=0, variant=""):
    """Return what each check of a task says of a subject: None where it holds."""
    return answered_and_asked(task, subject, seed, variant)[0]


def answered_and_asked(task, subject, seed=0, variant=""):
    """Return what each check of a task says of a subject, and the calls that each check made."""
    said = {}
    asked = []
    for name, check, *_ in checks(task, variant):
        before = len(subject.calls)
        said[name] = ask(check, subject, seed)
        calls = subject.calls[before:]
        asked.append(misconceptions.CheckedCalls(calls=calls, holds=said[name] is None))
    return said, asked


def score(task, subject, seed=0, variant=""):
    """Return what share of a task's points a subject gets, and what each check says: None where it holds.

    As in grading: a well-known mistake that explains all answers costs half at most.
    """
    said, asked = answered_and_asked(task, subject, seed, variant)
    found = misconceptions.Diagnosis()
    if any(said.values()):
        found = misconceptions.diagnose(PLAN.task(task)._replace(variant=variant), asked)
    worth = [Fraction(str(points)) for _, _, points, *_ in checks(task, variant)]
    each = [
        Check(task, name, name, Fraction(), points, "fails" if said[name] else "holds")
        for (name, *_), points in zip(checks(task, variant), worth, strict=True)
    ]
    needs = {name: needs or "" for name, *_, needs in checks(task, variant)}
    traced = scoring.attribute_failures(
        each, needs, named=found.explains_all, once=found.costs_half_at_most
    )
    return float(sum(one.points for one in traced) / sum(worth)), said
