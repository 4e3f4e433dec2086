"""Do the questions of `hdrlab viva` have one right answer, and is it hidden from who does not know the code?

Questions are made of the library's solutions, of the tests' files of equivalents and of the battery of right
answers, each with one seed after the other from VIVA_SEED on, until there are VIVA_QUESTIONS of them. They
are made in this process, since these answers are trusted and a sandbox for each costs twenty times as long,
and not five of a submission but all that there are: the first five are those of `hdrlab viva`.

again    every version of a question is run once more, in the sandbox: it has its own option's answer, and
         none of the three others
refused  submissions with five passing tasks or more, and fewer than five questions
blind    somebody who sees the options alone takes the one that has most in common with the others, or least;
         of pictures the one nearest to the others' mean, or farthest. Ties count by their share
places   how often the right one stands at A, B, C and D, in %
seconds  of a processor for `hdrlab viva`, all of it in the sandbox, with each homework's solution
"""

import math
import os
import re
import resource
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from copy import deepcopy
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks.experiments import Experiment, along, at_least, at_most, near
from benchmarks.fairness import submissions, texts
from benchmarks.measure import ROOT
from hdrlab.course import grading, plan
from hdrlab.course.checks import compare, misconceptions
from hdrlab.course.checks.subject import NoAnswer
from hdrlab.course.code.closure import Cell, closed
from hdrlab.course.code.names import imported
from hdrlab.course.plan import Conditions, Homework
from hdrlab.course.sandbox.inside import worker
from hdrlab.course.submission import Submission
from hdrlab.course.viva import examining, inputs, pages

QUESTIONS = int(os.environ.get("VIVA_QUESTIONS", "500"))
SEED = int(os.environ.get("VIVA_SEED", "0"))
TIER = os.environ.get("VIVA_TIER", "practice")
CONDITIONS = Conditions(TIER, draw=False)
# questions of a submission, at most; seconds and bytes of a call in this process
MOST, PATIENCE, MEMORY = 40, 1, 1 << 32
SECONDS = "CPU seconds for the questions of a homework: median, largest"
AGAIN, REFUSED = "right again, % of questions", "refused, % of submissions with five tasks"
ALIKE, ODD, PLACES = "blind, most alike, %", "blind, least alike, %", "places of right answers, %"


Question = dict[str, Any]


class InProcess:
    """What a check asks, as `checks.subject.Subject`, of functions to trust that run in this process."""

    said, left = "", math.inf

    def __init__(self, sources: dict[str, str]) -> None:
        self.texts, self.functions = dict(sources), dict[str, Any]()
        self.calls: list[Any] = []

    def fresh(self, **sources: str) -> None:
        """Know nothing of what was called before, with other texts of some tasks."""
        self.texts |= sources
        self.functions = {}

    def __getattr__(self, task: str) -> Any:
        def ask(*given: Any, **named: Any) -> Any:
            with in_time(), np.errstate(all="ignore"):
                if task not in self.functions:
                    scope: dict[str, Any] = {"__name__": task}
                    exec(compile(self.texts[task], task, "exec"), scope)
                    self.functions[task] = scope[task]
                answer = self.functions[task](*deepcopy(given), **deepcopy(named))
                answer = compare.plain(worker.drained(answer))
                if any(one.dtype.hasobject for one in inputs.arrays_in(answer)):
                    raise TypeError("an answer that is no array")  # the sandbox's channel refuses it
                return answer

        return ask


@contextmanager
def in_time() -> Iterator[None]:
    """Raise NoAnswer for whatever goes wrong, or lasts too long."""

    def late(*_: object) -> None:
        raise TimeoutError

    signal.signal(signal.SIGALRM, late)
    signal.alarm(PATIENCE)
    try:
        yield
    except Exception as error:
        raise NoAnswer(str(error), "late" if isinstance(error, TimeoutError) else "raised") from None
    finally:
        signal.alarm(0)


class Twice(examining.Asked):
    """A task that is asked about, all of whose four answers are computed once more, in the sandbox."""

    def question(self, kind: str) -> Question | None:
        """Return the question; what is wrong with this very code is written down."""
        try:
            return super().question(kind)
        except Exception as error:
            self.run._write(question={"fault": f"{kind} of {self.task}: {error!r}"})
            raise

    def holds(self, found: examining.Found) -> bool:
        """Return what this process says of a question, and write down what the sandbox says."""
        if not super().holds(found):
            return False
        run: Any = self.run
        run.submission, run.other = run.other, run.submission
        if run.submission.left < examining.WORN * run.job["timeout"]:
            examining.Examining._begin(run)
        found.shown["again"] = super().holds(found)
        run.submission, run.other = run.other, run.submission
        return True


class Examining(examining.Examining):
    """A run of the checks, after which questions are made in this process, and run again in the sandbox."""

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Write down questions, and what became of them when they were run again."""
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        examining.Asked = Twice  # type: ignore[misc]
        examining.QUESTIONS = int(self.job["most"])
        super().pytest_sessionfinish(session)

    def _begin(self) -> None:
        super()._begin()
        self.other, self.submission = self.submission, InProcess(self.job["sources"])  # type: ignore[assignment]


def works() -> Iterator[tuple[str, Homework, Submission]]:
    """Yield the submissions that are examined, each with its name."""
    homeworks = plan.read().homeworks
    for name, homework in homeworks.items():
        yield f"solutions {name}", homework, as_submission(solutions(homework))
    for path in sorted(ROOT.glob("tests/equivalent/*.py")):
        homework = homeworks[path.stem.partition("_")[0]]
        yield path.stem, homework, grading.read_tasks(path, homework, CONDITIONS)[0]
    for k, (homework, chosen) in enumerate(submissions(texts("right"))):
        yield f"right {k}", homework, as_submission({task: text for task, (_, text) in chosen.items()})


def solutions(homework: Homework) -> dict[str, str]:
    """Return the library's functions, each with all that it needs."""
    cells = [Cell(text, task) for task, text in misconceptions.solutions(homework.tasks).items()]
    return closed(cells, [task.id for task in homework.tasks])[0]


def as_submission(sources: dict[str, str] | Any) -> Submission:
    """Return sources as they are read from a file."""
    return Submission(dict(sources), (), "", tuple(imported(sources.values())))


def examined(
    item: tuple[str, Homework, Submission, int], by: str = "benchmarks.viva:Examining", most: int = MOST
) -> tuple[str, list[str], list[dict[str, Any]]]:
    """Return a name, the tasks that passed, and the questions."""
    name, homework, read, seed = item
    more = {"seed": str(plan.seed("viva", name, str(seed))), "photographs": pages.photographs([])}
    found = list(grading.heard_steps(read, homework, CONDITIONS, by=by, most=most, **more))
    passed = next(one["passed"] for one in found if "passed" in one)
    made = [one["question"] for one in found if "question" in one]
    for fault in [one["fault"] for one in made if "fault" in one]:
        print(f"  {name}: {fault}", flush=True)
    return name, passed, [one for one in made if "fault" not in one]


def features(question: dict[str, Any]) -> list[np.ndarray]:
    """Return what somebody sees of each option who does not know the code, as numbers."""
    if "figures" in question:
        return [
            np.array([float(one) for one in figure["parts"].split(", ")]) for figure in question["figures"]
        ]
    said = question.get("texts") or [f"row {one // 8} column {one % 8}" for one in question["marks"]]
    words = [set(re.findall(r"\w+|\W", one)) | {f"length {len(one) // 4}"} for one in [*said, ""][:4]]
    every = sorted(set().union(*words))
    return [np.array([float(word in one) for word in every]) for one in words]


def blind(question: dict[str, Any], most: bool) -> float:
    """Return the chance that who takes the option most, or least, like the others is right."""
    seen = np.array(features(question))
    far = np.abs(seen - (seen.sum(axis=0) - seen) / 3).sum(axis=1) * (1 if most else -1)
    best = np.isclose(far, far.min())
    return float(best[question["right"]] / best.sum())


def questions(_: Path) -> dict[str, Any]:
    """Return what is found of QUESTIONS questions."""
    every = list(works())
    every = [every[k] for k in np.random.default_rng(1).permutation(len(every))]
    asked: list[Question] = []
    refused, whole, seed = 0, 0, SEED
    while len(asked) < QUESTIONS:
        need = -(-(QUESTIONS - len(asked)) // examining.QUESTIONS)
        items = [(*one, seed) for one in every][:need]
        for name, passed, made in along(examined, items, f"seed {seed}"):
            asked += made
            whole += len(passed) >= examining.QUESTIONS
            short = len(passed) >= examining.QUESTIONS > len(made)
            refused += short
            for one in made:
                if not one["again"]:
                    print(f"  {name}, seed {seed}: {one['kind']} of {one['task']} is not right", flush=True)
            if short:
                print(f"  {name}: {len(made)} questions of {len(passed)} tasks", flush=True)
        seed += 1
    kinds = {kind: sum(one["kind"] == kind for one in asked) for kind in examining.KINDS}
    print("  " + ", ".join(f"{count} {kind}" for kind, count in kinds.items()), flush=True)
    places = np.bincount([one["right"] for one in asked], minlength=4)
    return {
        "questions": len(asked),
        AGAIN: 100 * np.mean([one["again"] for one in asked]),
        REFUSED: 100 * refused / max(whole, 1),
        ALIKE: 100 * np.mean([blind(one, True) for one in asked]),
        ODD: 100 * np.mean([blind(one, False) for one in asked]),
        PLACES: tuple(100 * places / places.sum()),
    }


def seconds(_: Path) -> dict[str, Any]:
    """Return what the questions of the library's solutions cost, one homework after the other."""
    took = []
    for name, homework, read in islice(works(), 5):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        made = examined((name, homework, read, 0), "hdrlab.course.viva.examining:Examining")[2]
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        took.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
        print(f"  {name}: {len(made)} questions, {took[-1]:.1f} s", flush=True)
    return {SECONDS: (float(np.median(took)), max(took))}


ROWS = (
    Experiment("seconds", "what five questions cost", seconds, (at_most(SECONDS, 20, 20),)),
    Experiment(
        "questions",
        "questions on right answers, each run again",
        questions,
        (
            at_least(AGAIN, 100),
            at_most(REFUSED, 0.5),
            near(ALIKE, 25, by=3),
            near(ODD, 25, by=3),
            near(PLACES, 25, 25, 25, 25, by=3),
        ),
    ),
)
