"""Correct answers that were written from the assignments alone pass all checks."""

import warnings
from pathlib import Path

import numpy as np
import pytest
import scoring

from hdrlab.course import plan
from hdrlab.course.authoring import solutions
from hdrlab.course.checks import compare, inprocess
from hdrlab.course.grading import grader, results
from hdrlab.course.submissions import reader

FAIRNESS = Path(__file__).parents[2] / "benchmarks" / "fairness"
pytestmark = [
    pytest.mark.grading,
    pytest.mark.skipif(
        not FAIRNESS.is_dir(), reason="benchmarks/ is no part of the installed package"
    ),
]


def score_answer(path):
    """Return the fraction of its task's points that an answer gets, and the error of each check."""
    task = path.parent.name
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")  # 0 / 0, as it may well happen in a student's process
        subject = inprocess.Subject({task: scoring.functions(path)[task]})
        return scoring.score(task, subject, plan.seed("secret", "ada", task))


# as slow as lsqr
WAYS = sorted(path for path in FAIRNESS.glob("right/*/*.py") if path.stem != "sparse_lsqr")


@pytest.mark.parametrize("path", WAYS, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_a_correct_solution_written_from_the_assignment_passes_every_check(path):
    share, outcomes = score_answer(path)
    assert share == 1, {name: str(error) for name, error in outcomes.items() if error}


@pytest.mark.parametrize(
    ("answer", "noted"),
    [
        ([0.0, 1.0, 0.0], "w: list of 3 was taken for an array of shape (3,)"),
        ([[0.0], [1.0], [0.0]], "w: shape (3, 1) was taken for (3,)"),
    ],
)
def test_numbers_in_another_form_are_accepted_and_noted(answer, noted):
    compare.notes.clear()
    assert compare.same(answer, [0, 1, 0], 0, what="w").shape == (3,)
    assert noted in compare.notes


@pytest.mark.parametrize("answer", [[1.0, [2.0]], [1.0, "2"], [[1.0, 2.0, 3.0, 4.0]], []])
def test_other_lists_are_not_accepted(answer):
    with pytest.raises(compare.AnswerMismatch):
        compare.same(answer, [1, 2], 0)


def test_the_fairness_benchmark_gives_the_same_points_and_mistake_as_check():
    """Both use a sandbox, and one of them pytest."""
    fairness = pytest.importorskip("benchmarks.fairness")
    way = "hat_zero_in_the_middle"
    whole_sheet = plan.read().homeworks["hw2"]
    task = plan.read().task("hat")
    homework = whole_sheet._replace(tasks=(task,))
    source = solutions.texts(homework, [way])["hat"]
    conditions = plan.GradingOptions("practice", "student 1", "fairness", draw=False)
    read = reader.SubmittedCode({"hat": source}, (), "", ())
    *_, result = grader.check_steps(read, homework, conditions)
    _, second = fairness.graded((homework, {"hat": (way, source)}, 2))
    earned, whole = results.points(result.of("hat"))
    assert second.share == earned / whole < 1
    assert second.named == (way,)
    assert "hat" in result.misconceptions
    assert list(second.broken) == [
        check.name for check in result.of("hat") if check.outcome != "holds"
    ]
