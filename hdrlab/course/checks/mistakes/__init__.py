"""Known mistakes: wrong versions of the tasks' functions, one module a task.

Each module `<task>.py` holds complete wrong functions, decorated with `mistake`. A student whose
answers agree with one of them is told what it says. The functions call numpy, scipy and the
library's helpers, and run in the grader's own process.
"""

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])
PACKAGE = "course.checks.mistakes"


@dataclass(frozen=True, kw_only=True)
class Question:
    """A small input on the way from a wrong answer to a mistake, for the tutor.

    Attributes
    ----------
    code : lines of Python. The last one is an expression whose value is a number that a student can
        work out by hand. NumPy is `np`, and the task's function has its own name.
    why : how to work it out
    because : the first words of the sentence of the assignment that says so; the sentence must be a
        demand in `hdrlab/course/checks/sentences`
    """

    code: str
    why: str
    because: str


@dataclass(frozen=True, kw_only=True)
class KnownMistake:
    """A wrong function and what a student reads about it.

    Attributes
    ----------
    name : the mistake's name, which begins with the id of its task
    task : the id of the task
    sentence : what a student reads who made it
    function : the wrong function
    misses_method : whether the mistake misses what the task is about. All others cost half of the
        task's points at most.
    source : the function's dotted path under `hdrlab`; "" for a mistake in an instructor's own task
    questions : three questions that lead to the mistake. The wrong function answers the last one
        wrongly. A mistake without questions gets those that the tutor makes from the counterexample.
    fixes : pieces of wrong code as students write them, and the right ones. Where such a change makes
        a student's function right, the tutor shows her the line. Changes between the wrong function
        and the solution are tried as well.
    """

    name: str
    task: str
    sentence: str
    function: Callable[..., Any]
    misses_method: bool = False
    source: str = ""
    questions: tuple[Question, ...] = ()
    fixes: tuple[tuple[str, str], ...] = ()

    @property
    def costs_half_at_most(self) -> bool:
        """Whether a student who made this mistake keeps at least half of the task's points."""
        return not self.misses_method


_registered: dict[str, list[KnownMistake]] = {}


def mistake(
    name: str,
    *,
    says: str,
    misses_method: bool = False,
    questions: tuple[Question, ...] = (),
    fixes: tuple[tuple[str, str], ...] = (),
) -> Callable[[Function], Function]:
    """Register the decorated function as a known mistake of the task that its module is named after.

    Parameters
    ----------
    name : the mistake's name: the task's id, an underscore, and a few words
    says : the sentence for the student: what is wrong, and what to do
    misses_method : whether the function misses what the task is about
    questions : three questions that lead to the mistake, or none
    fixes : pairs of wrong and right code, with which the tutor looks for the student's line

    Raises
    ------
    ValueError
        If the name does not begin with the task's id, or is taken.
    """

    def register(function: Function) -> Function:
        task = function.__module__.rpartition(".")[2]
        registered = _registered.setdefault(task, [])
        if not name.startswith(f"{task}_"):
            raise ValueError(f"{name}: start the name of a mistake with its task, {task}_")
        if any(known.name == name for known in registered):
            raise ValueError(f"{name}: two mistakes have this name; rename one of them")
        registered.append(
            KnownMistake(
                name=name,
                task=task,
                sentence=says,
                function=function,
                misses_method=misses_method,
                source=f"{PACKAGE}.{task}.{function.__name__}",
                questions=questions,
                fixes=fixes,
            )
        )
        return function

    return register


def tasks_with_mistakes() -> list[str]:
    """Return the ids of all tasks that have known mistakes, sorted."""
    modules = Path(__file__).parent.glob("*.py")
    return sorted(path.stem for path in modules if path.stem != "__init__")


@cache
def mistakes_of(task: str) -> tuple[KnownMistake, ...]:
    """Return the known mistakes of a task, sorted by name; an empty tuple if there are none.

    Examples
    --------
    >>> [known.name for known in mistakes_of("exclusion")][-1]
    'exclusion_inverted'
    """
    if task not in tasks_with_mistakes():
        return ()
    importlib.import_module(f"{__name__}.{task}")
    return tuple(sorted(_registered[task], key=lambda known: known.name))
