"""Is the grader fair? Right answers, and plausible wrong ones, go through the checks that a student meets.

right/<task>/<way>.py  a right way that keeps to what the task's sheet says: another order of a scan, another
                       solver, gauge, fill, rounding, type or shape; none may lose a point
wrong/<task>/<way>.py  a plausible answer without the method that is asked for; at most a third of the points;
                       one with the method and a known mistake in it is among the mistakes, at half
                       or more
mistakes               the named ones, of `hdrlab/course/checks/mistakes`: each strictly between, and named;
                       those that do not miss what their task is about cost half of it at most

What is wrong is to earn the same on all inputs: its score varies by a twentieth of the task's
points at most.

Every file is graded on SEEDS students' inputs in the practice tier. The k-th files of a homework's
tasks are one submission, whose functions answer all students' checks from one sandbox. A process of
its own for each check, the specification, the points and the names of mistakes are those of `check`
in a notebook. `SEEDS=3 python -m benchmarks fairness` is a shorter run.
"""

import inspect
import os
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from importlib import import_module
from itertools import zip_longest
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from benchmarks.experiments import Experiment, Hold, along, at_least, at_most
from hdrlab.course import plan
from hdrlab.course.authoring import solutions
from hdrlab.course.checks import compare, misconceptions
from hdrlab.course.checks.subject import NoAnswer, Subject
from hdrlab.course.grading import scoring
from hdrlab.course.grading.results import Check, Outcome
from hdrlab.course.limits import CALL_TIMEOUT_SECONDS
from hdrlab.course.plan import Homework
from hdrlab.course.sandbox import tiers
from hdrlab.course.sandbox.session import Unavailable
from hdrlab.course.source_code.names import imported_numpy_modules

HERE = Path(__file__).parent
# students, each with inputs of their own
SEEDS = int(os.environ.get("SEEDS", "25"))
# of a task's points, for what is plausible and wrong
THIRD = 1 / 3
# the same, by which the score of what is wrong may vary from student to student
TWENTIETH = 1 / 20


class Score(NamedTuple):
    """What an answer got for its task: the share of the points, the promises it broke, the mistakes named."""

    task: str
    way: str
    share: float
    broken: tuple[str, ...]
    named: tuple[str, ...]


def texts(kind: str) -> dict[str, dict[str, str]]:
    """Return the answers of a kind: task -> way -> source."""
    texts_found: dict[str, dict[str, str]] = {}
    for path in sorted(HERE.glob(f"{kind}/*/*.py")):
        texts_found.setdefault(path.parent.name, {})[path.stem] = path.read_text(encoding="utf8")
    return texts_found


def mistakes() -> dict[str, dict[str, str]]:
    """Return the named mistakes in the same form, each with all that it needs."""
    texts_found: dict[str, dict[str, str]] = {}
    for homework in plan.read().homeworks.values():
        for mistake in misconceptions.known():
            if mistake.task in [task.id for task in homework.tasks]:
                own = tuple(task for task in homework.tasks if task.id == mistake.task)
                cells = solutions.texts(homework._replace(tasks=own), [mistake.name])
                texts_found.setdefault(mistake.task, {})[mistake.name] = cells[mistake.task]
    return texts_found


def submissions(
    answers: dict[str, dict[str, str]],
) -> Iterator[tuple[Homework, dict[str, tuple[str, str]]]]:
    """Yield (homework, task -> (way, source)): the first way of each task, the second of each, and so on."""
    for homework in plan.read().homeworks.values():
        own = {task.id: list(answers.get(task.id, {}).items()) for task in homework.tasks}
        for row in zip_longest(*own.values()):
            chosen = {task: text for task, text in zip(own, row, strict=True) if text is not None}
            tasks = tuple(task for task in homework.tasks if task.id in chosen)
            yield homework._replace(tasks=tasks), chosen


def graded(item: tuple[Homework, dict[str, tuple[str, str]], int]) -> list[Score]:
    """Return what each answer of a submission gets on so many students' inputs."""
    homework, chosen, seeds = item
    sources = {task: source for task, (_, source) in chosen.items()}
    modules = tuple(imported_numpy_modules(sources.values()))
    with Subject(
        sources, tiers.choose("practice"), CALL_TIMEOUT_SECONDS * seeds, modules
    ) as subject:
        return [
            score(subject, task, chosen[task.id][0], f"student {k}")
            for k in range(seeds)
            for task in homework.tasks
        ]


def score(subject: Subject, task: plan.Task, way: str, student: str) -> Score:
    """Return what an answer gets on a student's inputs."""
    module = import_module(f"hdrlab.course.checks.specification.test_{task.id}")
    tests = {name: test for name, test in vars(module).items() if name.startswith("test_")}
    one_point = pytest.mark.points(1).mark  # of a check that says nothing of its weight
    marks = {name: getattr(test, "pytestmark", [one_point])[0] for name, test in tests.items()}
    worth = scoring.split_points(
        Fraction(str(task.points)), [Fraction(str(check.args[0])) for check in marks.values()]
    )
    checks = []
    checked_calls = []
    for (name, test), points in zip(tests.items(), worth, strict=True):
        subject.fresh()
        compare.notes.clear()
        arguments = {
            "subject": subject,
            "rng": np.random.default_rng(plan.seed("fairness", student, task.id)),
        }
        ended = Check(task.id, name, name, Fraction(), points, "holds")
        try:
            test(**{check: arguments[check] for check in inspect.signature(test).parameters})
        except Unavailable:  # the machine failed, not the answer
            raise
        except Exception as error:  # whatever an answer leads to costs that promise, and no other
            kind = error.kind if isinstance(error, NoAnswer) else ""
            outcome: Outcome = "no answer" if kind else "fails"
            ended = replace(ended, outcome=outcome, kind=kind, message=str(error))
        checks.append(ended)
        calls = [(check.args, check.kwargs, check.answer) for check in subject.calls]
        checked_calls.append(
            misconceptions.CheckedCalls(calls=calls, holds=ended.outcome == "holds")
        )
    broken = tuple(check.name for check in checks if check.outcome != "holds")
    diagnosis = (
        misconceptions.diagnose(task, checked_calls) if broken else misconceptions.Diagnosis()
    )
    needs = {name: check.kwargs.get("needs", "") for name, check in marks.items()}
    traced = scoring.attribute_failures(
        checks, needs, named=diagnosis.explains_all, once=diagnosis.costs_half_at_most
    )
    share = float(sum(check.points for check in traced) / sum(worth))
    return Score(task.id, way, share, broken, tuple(check.name for check in diagnosis.mistakes))


def scores(answers: dict[str, dict[str, str]], seeds: int) -> list[Score]:
    """Return the scores of all answers on so many students' inputs."""
    items = [(*submission, seeds) for submission in submissions(answers)]
    return [
        score for scores_of_item in along(graded, items, "submissions") for score in scores_of_item
    ]


def spread(scores_found: list[Score]) -> float:
    """Return by how much the score of one answer varies at most, and print of which it varies too much."""
    shares: dict[tuple[str, str], list[float]] = {}
    for score in scores_found:
        shares.setdefault((score.task, score.way), []).append(score.share)
    apart = {
        key: max(student_shares) - min(student_shares) for key, student_shares in shares.items()
    }
    for (task, way), most in apart.items():
        if most > TWENTIETH:
            print(
                f"  {task} {way}: from {min(shares[task, way]):.0%} to {max(shares[task, way]):.0%}"
            )
    return max(apart.values())


def table(scores_found: list[Score]) -> str:
    """Return a line for each task: its ways, answers, refusals, and the share of points, least and most."""
    lines = [f"  {'task':<20}{'ways':>6}{'answers':>9}{'refused':>9}{'least':>8}{'most':>8}"]
    for task in dict.fromkeys(score.task for score in scores_found):
        own = [score for score in scores_found if score.task == task]
        shares = [score.share for score in own]
        counts = (
            f"{len({score.way for score in own}):>6}{len(own):>9}{sum(s < 1 for s in shares):>9}"
        )
        lines.append(f"  {task:<20}{counts}{min(shares):>8.0%}{max(shares):>8.0%}")
    return "\n".join(lines)


def refusals(scores_found: list[Score]) -> list[str]:
    """Return which ways lost points, by which promises, and how often."""
    lost: dict[tuple[str, ...], int] = {}
    for score in scores_found:
        for promise in score.broken:
            lost[score.task, score.way, promise] = lost.get((score.task, score.way, promise), 0) + 1
    return [
        f"  {task} {way}: {promise}, {count} times" for (task, way, promise), count in lost.items()
    ]


def right(_: Path) -> dict[str, Any]:
    """Return how many right answers are refused."""
    scores_found = scores(texts("right"), SEEDS)
    print("\n".join([table(scores_found), *refusals(scores_found)]))
    ways = {(score.task, score.way) for score in scores_found}
    fewest = min(sum(task == score.id for task, _ in ways) for score in _tasks())
    return {
        "right ways, and answers": (len(ways), len(scores_found)),
        "fewest ways of a task": fewest,
        "right answers refused": sum(score.share < 1 for score in scores_found),
    }


def wrong(_: Path) -> dict[str, Any]:
    """Return what plausible answers without the method get."""
    scores_found = scores(texts("wrong"), SEEDS)
    print(table(scores_found))
    return {
        "wrong answers": len(scores_found),
        "largest share of a wrong answer": max(score.share for score in scores_found),
        "by which a score varies": spread(scores_found),
    }


def named(_: Path) -> dict[str, Any]:
    """Return what the named mistakes get, and how many are named."""
    scores_found = scores(mistakes(), SEEDS)
    print(table(scores_found))
    method = [score.name for score in misconceptions.known() if score.misses_method]
    print(f"  of these miss what their task is about: {', '.join(method)}")
    return {
        "answers with a mistake": len(scores_found),
        "of which with no point or all": sum(score.share in (0, 1) for score in scores_found),
        "of the others, that cost more than half": sum(
            score.share < 1 / 2 and score.way not in method for score in scores_found
        ),
        "named, %": 100
        * sum(score.named == (score.way,) for score in scores_found)
        / len(scores_found),
        "by which a score varies": spread(scores_found),
    }


def _tasks() -> list[plan.Task]:
    return [task for homework in plan.read().homeworks.values() for task in homework.tasks]


NONE_REFUSED: Hold = at_most("right answers refused", 0)
ALIKE: Hold = at_most("by which a score varies", TWENTIETH)
ROWS = (
    Experiment(
        "right",
        "right answers from the sheets",
        right,
        (NONE_REFUSED, at_least("fewest ways of a task", 6)),
    ),
    Experiment(
        "wrong",
        "plausible answers without the method",
        wrong,
        (at_most("largest share of a wrong answer", THIRD), ALIKE),
    ),
    Experiment(
        "mistakes",
        "the named mistakes",
        named,
        (
            at_most("of which with no point or all", 0),
            at_most("of the others, that cost more than half", 0),
            at_least("named, %", 95),
            ALIKE,
        ),
    ),
)
