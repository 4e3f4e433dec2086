"""Do the questions of `hdrlab viva` have one right answer, and is it hidden from who does not know the code?

Questions are made of the library's solutions, of the tests' files of equivalents and of the battery
of right answers, each with one seed after the other from VIVA_SEED on, of many tasks with more of
them, until there are VIVA_QUESTIONS. They are made as `twice` says, and not five of a submission
but all that there are: the first five are those of `hdrlab viva`.

again    every version of a question is run once more, in the sandbox: it has its own option's answer, and
         none of the three others
refused  submissions with five passing tasks or more, and fewer than five questions
blind    somebody who sees the options alone takes the one that has most in common with the others, or least;
         of pictures the one nearest to the others' mean, or farthest. Ties count by their share
places   how often the right one stands at A, B, C and D, in %
seconds  of a processor for `hdrlab viva`, all of it in the sandbox, with each homework's solution
"""

import os
import re
import resource
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

from benchmarks.experiments import Experiment, along, at_least, at_most, near
from benchmarks.fairness import submissions, texts
from benchmarks.measure import ROOT
from hdrlab.course import plan
from hdrlab.course.checks import misconceptions
from hdrlab.course.grading import grader
from hdrlab.course.plan import GradingOptions, Homework
from hdrlab.course.source_code.closure import Cell, extract_sources
from hdrlab.course.source_code.names import imported_numpy_modules
from hdrlab.course.submissions.reader import SubmittedCode
from hdrlab.course.viva import examining, pages

QUESTIONS = int(os.environ.get("VIVA_QUESTIONS", "500"))
SEED = int(os.environ.get("VIVA_SEED", "0"))
TIER = os.environ.get("VIVA_TIER", "practice")
CONDITIONS = GradingOptions(TIER, draw=False)
QUESTIONS_PER_SITTING = examining.MAX_QUESTIONS
# about as many questions come from a submission
USUAL_QUESTIONS = 8
MAX_TASKS = 16
# for all sittings of a submission
MAX_SECONDS = 36_000.0
SECONDS = "CPU seconds for the questions of a homework: median, largest"
AGAIN = "right again, % of questions"
REFUSED = "refused, % of submissions with five tasks"
ALIKE = "blind, most alike, %"
ODD = "blind, least alike, %"
PLACES = "places of right answers, %"

Question = dict[str, Any]


def works() -> Iterator[tuple[str, Homework, SubmittedCode]]:
    """Yield the submissions that are examined, each with its name."""
    homeworks = plan.read().homeworks
    for name, homework in homeworks.items():
        yield f"solutions {name}", homework, as_submission(solutions(homework))
    for path in sorted(ROOT.glob("tests/equivalent/*.py")):
        homework = homeworks[path.stem.partition("_")[0]]
        yield path.stem, homework, grader.read_tasks(path, homework, CONDITIONS)[0]
    for k, (homework, chosen) in enumerate(submissions(texts("right"))):
        yield (
            f"right {k}",
            homework,
            as_submission({task: text for task, (_, text) in chosen.items()}),
        )


def solutions(homework: Homework) -> dict[str, str]:
    """Return the library's functions, each with all that it needs."""
    cells = [Cell(text, task) for task, text in misconceptions.solutions(homework.tasks).items()]
    return extract_sources(cells, [task.id for task in homework.tasks])[0]


def as_submission(sources: dict[str, str] | Any) -> SubmittedCode:
    """Return sources as they are read from a file."""
    return SubmittedCode(dict(sources), (), "", tuple(imported_numpy_modules(sources.values())))


def examined(
    item: tuple[str, Homework, SubmittedCode, list[int]],
    by: str = "benchmarks.viva.twice:Examining",
    most: int = 40,
) -> tuple[str, list[tuple[list[str], list[Question]]]]:
    """Return a name, and of each seed's sitting the tasks that passed and the questions, `most` of them."""
    name, homework, read, seeds = item
    sittings = [str(plan.seed("viva", name, str(seed))) for seed in seeds]
    more = {
        "seed": sittings[0],
        "sittings": sittings,
        "most": most,
        "photographs": pages.photographs([]),
    }
    made: list[tuple[list[str], list[Question]]] = []
    with patch.object(grader, "ALL_CHECKS_TIMEOUT_SECONDS", MAX_SECONDS):
        events = list(grader.iter_events(read, homework, CONDITIONS, by=by, **more))
    for event in events:
        if "passed" in event:
            made.append((event["passed"], []))
        if "fault" in (question := event.get("question", {})):
            print(f"  {name}: {question['fault']}", flush=True)
        elif question:
            made[-1][1].append(question)
            if not question.get("again", True):
                output = f"{question['kind']} of {question['task']}"
                print(f"  {name}, seed {seeds[len(made) - 1]}: {output} is not right", flush=True)
    return name, made


def features(question: dict[str, Any]) -> list[np.ndarray]:
    """Return what somebody sees of each option who does not know the code, as numbers."""
    if "figures" in question:
        return [
            np.array([float(text) for text in figure["parts"].split(", ")])
            for figure in question["figures"]
        ]
    texts = question.get("texts") or [
        f"row {text // 8} column {text % 8}" for text in question["marks"]
    ]
    words = [
        set(re.findall(r"\w+|\W", text)) | {f"length {len(text) // 4}"} for text in [*texts, ""][:4]
    ]
    every = sorted(set().union(*words))
    return [np.array([float(word in text) for word in every]) for text in words]


def blind(question: dict[str, Any], most: bool) -> float:
    """Return the chance that who takes the option most, or least, like the others is right."""
    seen = np.array(features(question))
    far = np.abs(seen - (seen.sum(axis=0) - seen) / 3).sum(axis=1) * (1 if most else -1)
    best = np.isclose(far, far.min())
    return float(best[question["right"]] / best.sum())


def questions(_folder: Path) -> dict[str, Any]:
    """Return what is found of QUESTIONS questions."""
    every = list(works())
    every = [every[k] for k in np.random.default_rng(1).permutation(len(every))]
    questions_found: list[Question] = []
    refused = 0
    whole = 0
    seed = SEED
    while (need := QUESTIONS - len(questions_found)) > 0:
        count = -(-need // (USUAL_QUESTIONS * len(every)))
        seeds = list(range(seed, seed + count))
        items = [(*item, seeds[: -(-count * len(item[2].sources) // MAX_TASKS)]) for item in every]
        items = items[: -(-need // (USUAL_QUESTIONS * count))]
        for name, sittings in along(examined, items, f"seeds {seeds[0]} to {seeds[-1]}"):
            for seed, (passed, made) in zip(seeds, sittings, strict=False):
                questions_found += made
                whole += len(passed) >= QUESTIONS_PER_SITTING
                if len(passed) >= QUESTIONS_PER_SITTING > len(made):
                    refused += 1
                    print(
                        f"  {name}, seed {seed}: {len(made)} questions of {len(passed)} tasks",
                        flush=True,
                    )
        seed = seeds[-1] + 1
    kinds = {
        kind: sum(item["kind"] == kind for item in questions_found) for kind in examining.KINDS
    }
    print("  " + ", ".join(f"{count} {kind}" for kind, count in kinds.items()), flush=True)
    places = np.bincount([item["right"] for item in questions_found], minlength=4)
    return {
        "questions": len(questions_found),
        AGAIN: 100 * np.mean([item["again"] for item in questions_found]),
        REFUSED: 100 * refused / max(whole, 1),
        ALIKE: 100 * np.mean([blind(item, True) for item in questions_found]),
        ODD: 100 * np.mean([blind(item, False) for item in questions_found]),
        PLACES: tuple(100 * places / places.sum()),
    }


def seconds(_folder: Path) -> dict[str, Any]:
    """Return what the questions of the library's solutions cost, one homework after the other."""
    took = []
    for name, homework, read in islice(works(), 5):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        ((_, made),) = examined(
            (name, homework, read, [0]), "hdrlab.course.viva.examining:Examining"
        )[1]
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
