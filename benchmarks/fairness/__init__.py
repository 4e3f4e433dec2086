"""Is the grader fair? Right answers, and plausible wrong ones, go through the checks that a student meets.

right/<task>/<way>.py  a right way that keeps to what the task's sheet says: another order of a scan, another
                       solver, gauge, fill, rounding, type or shape; none may lose a point
wrong/<task>/<way>.py  a plausible answer without the method that is asked for; at most a third of the points;
                       one with the method and a known mistake in it is among the mistakes, at half or more
mistakes               the named ones, of `hdrlab/course/checks/mistakes`: each strictly between, and named;
                       those that do not miss what their task is about cost half of it at most

Every file is graded on SEEDS students' inputs in the practice tier, as `check` in a notebook does it. The
k-th files of a homework's tasks are one submission. `SEEDS=3 python -m benchmarks fairness` is a shorter run.
"""

import os
from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.experiments import Experiment, Hold, along, at_least, at_most
from hdrlab.course import grading, plan
from hdrlab.course.checks import misconceptions
from hdrlab.course.classroom import imitation
from hdrlab.course.code.names import imported
from hdrlab.course.plan import Conditions, Homework
from hdrlab.course.reports import results
from hdrlab.course.submission import Submission

HERE = Path(__file__).parent
# students, each with inputs of their own
SEEDS = int(os.environ.get("SEEDS", "25"))
# of a task's points, for what is plausible and wrong
THIRD = 1 / 3


class Score(NamedTuple):
    """What an answer got for its task: the share of the points, the promises it broke, the mistake named."""

    task: str
    way: str
    share: float
    broken: tuple[str, ...]
    named: str


def texts(kind: str) -> dict[str, dict[str, str]]:
    """Return the answers of a kind: task -> way -> source."""
    found: dict[str, dict[str, str]] = {}
    for path in sorted(HERE.glob(f"{kind}/*/*.py")):
        found.setdefault(path.parent.name, {})[path.stem] = path.read_text(encoding="utf8")
    return found


def mistakes() -> dict[str, dict[str, str]]:
    """Return the named mistakes in the same form, each with all that it needs."""
    found: dict[str, dict[str, str]] = {}
    for homework in plan.read().homeworks.values():
        for one in misconceptions.known():
            if one.task in [task.id for task in homework.tasks]:
                own = tuple(task for task in homework.tasks if task.id == one.task)
                cells = imitation.texts(homework._replace(tasks=own), [one.name])
                found.setdefault(one.task, {})[one.name] = cells[one.task]
    return found


def submissions(answers: dict[str, dict[str, str]]) -> Iterator[tuple[Homework, dict[str, tuple[str, str]]]]:
    """Yield (homework, task -> (way, source)): the first way of each task, the second of each, and so on."""
    for homework in plan.read().homeworks.values():
        own = {task.id: list(answers.get(task.id, {}).items()) for task in homework.tasks}
        for row in zip_longest(*own.values()):
            chosen = {task: one for task, one in zip(own, row, strict=True) if one is not None}
            tasks = tuple(task for task in homework.tasks if task.id in chosen)
            yield homework._replace(tasks=tasks), chosen


def graded(item: tuple[Homework, dict[str, tuple[str, str]], str]) -> list[Score]:
    """Return what each answer of a submission gets on one student's inputs."""
    homework, chosen, student = item
    sources = {task: source for task, (_, source) in chosen.items()}
    read = Submission(sources, (), "", tuple(imported(sources.values())))
    conditions = Conditions("practice", student, "fairness", draw=False)
    *_, result = grading.check_steps(read, homework, conditions)
    found = []
    for task, (way, _) in chosen.items():
        earned, whole = results.points(result.of(task))
        broken = tuple(one.promise for one in result.of(task) if one.points < one.max_points)
        found.append(Score(task, way, earned / whole, broken, result.misconceptions.get(task, "")))
    return found


def scores(answers: dict[str, dict[str, str]], seeds: int) -> list[Score]:
    """Return the scores of all answers on so many students' inputs."""
    items = [(*one, f"student {k}") for one in submissions(answers) for k in range(seeds)]
    return [score for each in along(graded, items, "answers") for score in each]


def table(found: list[Score]) -> str:
    """Return a line for each task: its ways, answers, refusals, and the share of points, least and most."""
    lines = [f"  {'task':<20}{'ways':>6}{'answers':>9}{'refused':>9}{'least':>8}{'most':>8}"]
    for task in dict.fromkeys(one.task for one in found):
        own = [one for one in found if one.task == task]
        shares = [one.share for one in own]
        counts = f"{len({one.way for one in own}):>6}{len(own):>9}{sum(s < 1 for s in shares):>9}"
        lines.append(f"  {task:<20}{counts}{min(shares):>8.0%}{max(shares):>8.0%}")
    return "\n".join(lines)


def refusals(found: list[Score]) -> list[str]:
    """Return which ways lost points, by which promises, and how often."""
    lost: dict[tuple[str, ...], int] = {}
    for one in found:
        for promise in one.broken:
            lost[one.task, one.way, promise] = lost.get((one.task, one.way, promise), 0) + 1
    return [f"  {task} {way}: {promise}, {count} times" for (task, way, promise), count in lost.items()]


def right(_: Path) -> dict[str, Any]:
    """Return how many right answers are refused."""
    found = scores(texts("right"), SEEDS)
    print("\n".join([table(found), *refusals(found)]))
    ways = {(one.task, one.way) for one in found}
    fewest = min(sum(task == one.id for task, _ in ways) for one in _tasks())
    return {
        "right ways, and answers": (len(ways), len(found)),
        "fewest ways of a task": fewest,
        "right answers refused": sum(one.share < 1 for one in found),
    }


def wrong(_: Path) -> dict[str, Any]:
    """Return what plausible answers without the method get."""
    found = scores(texts("wrong"), SEEDS)
    print(table(found))
    return {"wrong answers": len(found), "largest share of a wrong answer": max(one.share for one in found)}


def named(_: Path) -> dict[str, Any]:
    """Return what the named mistakes get, and how many are named."""
    found = scores(mistakes(), max(SEEDS // 5, 1))
    print(table(found))
    sentences = {one.name: one.sentence for one in misconceptions.known()}
    method = [one.name for one in misconceptions.known() if not one.once]
    print(f"  of these miss what their task is about: {', '.join(method)}")
    return {
        "answers with a mistake": len(found),
        "of which with no point or all": sum(one.share in (0, 1) for one in found),
        "of the others, that cost more than half": sum(
            one.share < 1 / 2 and one.way not in method for one in found
        ),
        "named, %": 100 * sum(one.named == sentences[one.way] for one in found) / len(found),
    }


def _tasks() -> list[plan.Task]:
    return [task for homework in plan.read().homeworks.values() for task in homework.tasks]


NONE_REFUSED: Hold = at_most("right answers refused", 0)
ROWS = (
    Experiment(
        "right", "right answers from the sheets", right, (NONE_REFUSED, at_least("fewest ways of a task", 6))
    ),
    Experiment(
        "wrong",
        "plausible answers without the method",
        wrong,
        (at_most("largest share of a wrong answer", THIRD),),
    ),
    Experiment(
        "mistakes",
        "the named mistakes",
        named,
        (
            at_most("of which with no point or all", 0),
            at_most("of the others, that cost more than half", 0),
            at_least("named, %", 95),
        ),
    ),
)
