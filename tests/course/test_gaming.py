"""Answers without the work, such as constants or the input itself, earn few points."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import scoring

from hdrlab.capture import responses
from hdrlab.course import plan
from hdrlab.course.checks import inprocess
from hdrlab.course.grading import grader
from hdrlab.course.plan import GradingOptions
from hdrlab.course.submissions.reader import SubmittedCode

PLAN = plan.read()
EMPTY_SUBMISSION = SubmittedCode({}, (), "")
WITH = GradingOptions("strict", "ada", "salt")
WITHOUT = GradingOptions("strict", "ada")
IDS = [task.id for homework in PLAN.homeworks.values() for task in homework.tasks]
# a constant answer may divide by 0
pytestmark = [pytest.mark.grading, pytest.mark.filterwarnings("ignore")]


def filled(answer, value):
    """Return an answer of the same form in which every number is replaced; bytes stay."""
    if isinstance(answer, tuple | list):
        return type(answer)(filled(item, value) for item in answer)
    return b"" if isinstance(answer, bytes) else value(np.asarray(answer))


def of_the_right_form(value):
    def cheat(task):
        right = plan.function(PLAN.task(task))
        return lambda *arguments, **named: filled(
            inprocess.plain(right(*arguments, **named)), value
        )

    return cheat


CHEATS = {
    "zeros": of_the_right_form(np.zeros_like),
    "ones": of_the_right_form(np.ones_like),
    "halves": of_the_right_form(
        lambda x: np.full(x.shape, 0.5 if x.dtype.kind == "f" else 128).astype(x.dtype)
    ),
    "a ramp": of_the_right_form(lambda x: np.linspace(0, 1, x.size).reshape(x.shape)),
    "the input": lambda task: lambda first, *others, **named: first,
    "the input and nothing": lambda task: (
        lambda first, *others, **named: (first, np.zeros_like(first))
    ),
    "the input as a state": lambda task: lambda first, *others, **named: [first] * 3,
}


@pytest.mark.parametrize("task", IDS)
@pytest.mark.parametrize("cheat", CHEATS)
def test_a_trivial_answer_earns_at_most_a_tenth_of_the_points(task, cheat):
    subject = inprocess.Subject({task: CHEATS[cheat](task)})
    assert scoring.score(task, subject, plan.seed("secret", "ada", task))[0] <= 0.1


@pytest.mark.parametrize(
    ("task", "cheat", "most"),
    [
        ("layers", lambda lL, **named: (lL / 2, lL - lL / 2), 0.2),
        ("layers", lambda lL, **named: (lL - lL.mean(), lL * 0 + lL.mean()), 0.0),
        ("scale", lambda L, headroom, sigma: 1 / (headroom * L), 0.3),
        ("scale", lambda L, headroom, sigma: 1 / (headroom * np.full_like(L, L.mean())), 0.3),
        ("align", lambda images, bits=6: np.zeros((len(images), 2)), 0.0),
        ("align", lambda images, bits=6: np.cumsum(np.ones((len(images), 2)), axis=0), 0.1),
        ("tonemap", lambda L: np.full(np.shape(L), 0.5, np.float32), 0.0),
        ("adjust_steps", lambda h, db, D, **named: [np.minimum(h, 1.0)], 0.0),
        ("count", lambda *arguments, **named: 1, 0.1),
    ],
)
def test_a_plausible_answer_without_the_method_earns_little(task, cheat, most):
    for student in ("ada", "grace"):
        assert (
            scoring.score(
                task, inprocess.Subject({task: cheat}), plan.seed("secret", student, task)
            )[0]
            <= most
        )


# hw2 by heart: of the public curves, the one that fits the data best


@cache
def known():
    return np.stack([responses.true_g(name) for name in responses.RESPONSES])


def best(Z, B):
    """Return the published g that agrees best with the samples Z (N, P)."""
    seen = np.where((Z > 20) & (Z < 235), 1.0, np.nan)
    deviations = [np.nanmean(np.nanstd((g[Z] - B) * seen, axis=1)) for g in known()]
    return known()[int(np.argmin(deviations))]


def gsolve(Z, B, smoothness, w):
    Z = np.asarray(Z)
    n = len(w)
    g = best(Z * (256 // n), B)[:: 256 // n]
    mass = w[Z] + 1e-9
    return g, (mass * (g[Z] - B)).sum(axis=1) / mass.sum(axis=1)


def recover(images, times, **named):
    Z = images.reshape(len(images), -1, *images.shape[3:])
    if Z.ndim == 3:
        return np.stack([best(Z[..., c].T, np.log(times)) for c in range(Z.shape[2])], axis=1)
    return best(Z.T, np.log(times))


def recover_steps(Z, times, w=None, max_iterations=30, **named):
    f = np.exp(best(Z, np.log(times)))
    return [f * (1 + 0.5**k * np.linspace(0, 0.1, 256)) for k in range(max_iterations + 1)]


@pytest.mark.parametrize("student", ["ada", "grace", "b02"])
def test_hard_coded_curves_earn_little(student):
    earned = {}
    for cheat in (gsolve, recover, recover_steps):
        task = PLAN.task(cheat.__name__)
        subject = inprocess.Subject({task.id: cheat})
        earned[task.id] = (
            task.points * scoring.score(task.id, subject, plan.seed("secret", student, task.id))[0]
        )
    assert sum(earned.values()) <= 15, earned  # of 70


@pytest.mark.parametrize("task", ["gsolve", "recover", "recover_steps"])
def test_the_library_passes_with_the_camera_of_any_student(task):
    for student in range(3):
        share, outcomes = scoring.score(
            task, inprocess.library(), plan.seed("secret", f"b{student}", task)
        )
        assert share == 1, (student, outcomes)


@pytest.mark.parametrize(("student", "secret"), [("", ""), ("ada", ""), ("", "salt")])
def test_a_result_with_inputs_drawn_without_a_secret_is_not_for_credit(student, secret, tmp_path):
    homework = PLAN.homeworks["hw2"]._replace(tasks=(PLAN.task("hat"),))
    (tmp_path / "hw2.py").write_text("")
    result = next(
        grader.grade_steps(
            tmp_path / "hw2.py", homework, GradingOptions("practice", student, secret)
        )
    )
    strict = replace(result, tier="strict")
    assert not strict.for_credit
    assert "without a secret" in strict.why_practice
    drawn = next(
        grader.grade_steps(tmp_path / "hw2.py", homework, GradingOptions("practice", "ada", "salt"))
    )
    assert replace(drawn, tier="strict").for_credit


def test_a_check_earns_nothing_if_the_check_that_it_needs_fails(tmp_path):
    homework = PLAN.homeworks["hw4"]._replace(tasks=(PLAN.task("scale"),))
    (tmp_path / "hw4.py").write_text(
        "def scale(L, headroom=8.0, sigma=1.0):\n    return 1 / (headroom * L)\n"
    )
    result = grader.grade(
        tmp_path / "hw4.py", homework, GradingOptions("practice", "ada", "salt", draw=False)
    )
    of = {check.name: check for check in result.checks}
    unit = of["test_the_unit_of_luminance_cancels"]
    assert unit.outcome == "holds" and unit.points == 0 and "1" not in unit.message
    assert "too: It is one over k times the blur" in unit.message
    earned = {"test_every_pixel_has_a_scale_above_0", "test_a_uniform_image_is_shown_at_one_over_k"}
    assert result.score == sum(of[name].max_points for name in earned)
