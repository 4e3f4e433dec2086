"""What checking costs, in starts of Python with NumPy and SciPy: a measure that travels between machines.

grading    a check of one wrong function, and of a homework, as a student starts them in a notebook
homeworks  all checks of a homework, on the library, in processor time
start      a check begins in the sandbox that is open already: its function is there, and has answered
hostile    a file that was made to be dear to read, in processor time, and how the cost grows with the file
"""

import inspect
import os
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from importlib import import_module
from math import log2
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.experiments import Experiment, Skipped, at_most
from hdrlab.course import plan
from hdrlab.course.checks import inprocess
from hdrlab.course.checks.subject import Subject
from hdrlab.course.grading import grader
from hdrlab.course.plan import GradingOptions
from hdrlab.course.sandbox import tiers
from hdrlab.course.source_code import closure, inline

STARTS = 7
TRIES = 50
SCALED = "def scaled(x): return 2 * x\n"
CHANGES = 500
LOADED = "numpy, scipy.linalg, scipy.ndimage, pytest, hdrlab.response.debevec, hdrlab.course.grading.grader"


def start(clock: Callable[[], float], loaded: str = "numpy, scipy.ndimage, scipy.linalg") -> float:
    """Return what it takes to start Python with NumPy and SciPy: the least of a few."""
    command = [sys.executable, "-c", f"import {loaded}"]
    return min(_seconds(lambda: subprocess.run(command, check=True), clock) for _ in range(STARTS))


def _of_children() -> float:
    """Return the processor time of what this process has started."""
    used = os.times()
    return used.children_user + used.children_system


def _seconds(act: Callable[[], Any], clock: Callable[[], float] = time.perf_counter) -> float:
    begun = clock()
    act()
    return clock() - begun


def _of_all() -> float:
    return time.process_time() + _of_children()


def homeworks(folder: Path) -> dict[str, Any]:
    """Return what all checks of each homework cost."""
    seconds_once = start(_of_children)
    plans = plan.read().homeworks
    spent = {
        name: sum(_seconds(partial(_check, task.id), time.process_time) for task in homework.tasks)
        for name, homework in plans.items()
    }
    return {
        "starts of Python, the dearest homework": max(spent.values()) / seconds_once,
        "s of a start": seconds_once,
    } | {f"starts of Python, {name}": seconds / seconds_once for name, seconds in spent.items()}


def _check(task: str) -> None:
    """Run every check of a task on the library's function."""
    module = import_module(f"hdrlab.course.checks.specification.test_{task}")
    arguments = {"subject": inprocess.library(), "rng": np.random.default_rng(0)}
    for name, check in vars(module).items():
        if name.startswith("test_"):
            check(**{word: arguments[word] for word in inspect.signature(check).parameters})


def graded(folder: Path) -> dict[str, Any]:
    """Return what it costs to check a wrong function, whose difference is drawn, and a whole homework."""
    both = plan.read().homeworks["hw2"]
    tasks = {task.id: task.function for task in both.tasks}
    alone = both._replace(tasks=tuple(task for task in both.tasks if task.id == "gsolve"))
    wrong = inline.inlined({"gsolve": tasks["gsolve"]})["gsolve"].text
    files = {folder / "wrong.py": wrong.replace("(smoothness * w[1:-1]) ** 2", "1.0")}
    files |= {
        folder / "whole.py": "\n\n".join(block.text for block in inline.inlined(tasks).values())
    }
    spent = []
    for (file, text), homework in zip(files.items(), (alone, both), strict=True):
        file.write_text(text)
        act = partial(grader.grade, file, homework, GradingOptions(tier="practice"))
        # what is loaded once is not the work's
        spent.append(min(_seconds(act, _of_all) for _ in range(3)))
    return {
        "starts of Python, a check and a homework": np.array(spent) / start(_of_children, LOADED)
    }


def begins(folder: Path) -> dict[str, Any]:
    """Return how long a check takes to begin: the quickest of many, the others wait for processors."""
    try:
        with Subject({"scaled": SCALED}, tiers.choose("strict"), 10.0) as subject:
            subject.scaled(1.0)
            spent = [_seconds(partial(_begin, subject)) for _ in range(TRIES)]
    except tiers.Unavailable as reason:
        raise Skipped(str(reason)) from None
    return {
        "starts of Python, a check begins": min(spent) / start(time.perf_counter),
        "ms, the quickest": 1e3 * min(spent),
    }


def _begin(subject: Subject) -> None:
    subject.fresh()
    subject.scaled(1.0)


def hostile(folder: Path) -> dict[str, Any]:
    """Return what a file costs that changes one thing many times."""
    once = _seconds(partial(_read, CHANGES), time.process_time)
    twice = _seconds(partial(_read, 2 * CHANGES), time.process_time)
    return {
        f"starts of Python, {2 * CHANGES} changes": twice / start(_of_children),
        "power of the changes that it grows with": log2(twice / once),
    }


def _read(changes: int) -> None:
    cell = closure.Cell("a = []\n" + "a.append(a)\n" * changes + "def gsolve(): return a\n")
    closure.extract_sources([cell], ["gsolve"])


ROWS = (
    Experiment(
        "grading",
        "one wrong function, and a homework, checked in the practice tier",
        graded,
        (at_most("starts of Python, a check and a homework", 4, 8),),
    ),
    Experiment(
        "homeworks",
        "all checks of a homework, on the library",
        homeworks,
        (at_most("starts of Python, the dearest homework", 12),),
    ),
    Experiment(
        "start",
        "a check begins in a sandbox that is open already",
        begins,
        (at_most("starts of Python, a check begins", 0.25),),
    ),
    Experiment(
        "hostile",
        "a file that is dear to read",
        hostile,
        (
            at_most(f"starts of Python, {2 * CHANGES} changes", 12),
            at_most("power of the changes that it grows with", 1.5),
        ),
    ),
)
