"""Recognise a known mistake: the answers agree with a wrong function, and not with the library.

The wrong functions of the course's tasks are in `hdrlab.course.checks.mistakes`. An instructor's
own task has a folder `mistakes` beside it. A wrong function answers the same questions as the
student did. Answers are compared after removing the scale or gauge that the checks leave free.

call        (arguments, keyword arguments, answer) of one call; the answer is None if none came
difference  between two answers, relative: 0 is equal, 1 about as large as the answer itself
"""

import runpy
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from hdrlab.core.arrays import F64
from hdrlab.course import plan
from hdrlab.course.checks import compare
from hdrlab.course.checks.mistakes import KnownMistake, mistakes_of, tasks_with_mistakes
from hdrlab.course.source_code import inline
from hdrlab.course.variants import rewording

Call = tuple[Sequence[Any], dict[str, Any], Any]

# relative difference that float32 or another solver may cause
ROUNDING = 1e-3
# part of the difference to the library that a wrong function may leave unexplained
MAX_UNEXPLAINED = 0.1
# the difference of answers that cannot be compared, such as two shapes
MAX_DIFFERENCE = 1e3


@cache
def known() -> tuple[KnownMistake, ...]:
    """Return the known mistakes of all tasks that come with hdrlab, sorted by name."""
    mistakes = [mistake for task in tasks_with_mistakes() for mistake in mistakes_of(task)]
    return tuple(sorted(mistakes, key=lambda mistake: mistake.name))


def of_task(task: plan.Task) -> Sequence[KnownMistake]:
    """Return the known mistakes of a task: the library's, or those beside an instructor's own task."""
    if task.own is None:
        return [_of_variant(mistake, task.variant) for mistake in mistakes_of(task.id)]
    files = sorted((task.own.parent / "mistakes").rglob(f"{task.id}_*.py"))
    return [_read_own(path, task.id) for path in files]


def _of_variant(mistake: KnownMistake, variant: str) -> KnownMistake:
    """Return a mistake as it looks in a variant of its task."""
    if not variant:
        return mistake
    return replace(
        mistake,
        sentence=rewording.reword(mistake.task, variant, mistake.sentence),
        function=partial(_call_variant, mistake.task, mistake.source, variant),
    )


def _call_variant(task: str, source: str, variant: str, /, *args: Any, **kwargs: Any) -> Any:
    return rewording.function(task, source, variant)(*args, **kwargs)


def _read_own(path: Path, task: str) -> KnownMistake:
    """Return the mistake that a file beside an instructor's own task holds."""
    names = runpy.run_path(str(path))
    return KnownMistake(
        name=path.stem,
        task=task,
        sentence=" ".join(names["__doc__"].split()),
        function=names[task],
        misses_method=path.parent.name == "method",
    )


@cache
def _by_name() -> dict[str, KnownMistake]:
    return {mistake.name: mistake for mistake in known()}


def solutions(tasks: Sequence[plan.Task], mistakes: Iterable[str] = ()) -> Mapping[str, str]:
    """Return the text of each task's cell: the library's solution, or a named mistake.

    Parameters
    ----------
    tasks : the tasks of one homework, with their variants
    mistakes : names of known mistakes, at most one for each task

    Returns
    -------
    The text of each task's cell, by the task's id. Together the cells need numpy and scipy alone.
    """
    functions = {task.id: task.function for task in tasks}
    for name in mistakes:
        mistake = _by_name()[name]
        functions[mistake.task] = mistake.source
    blocks = inline.inlined(functions)
    return {
        task.id: rewording.reword(task.id, task.variant, blocks[task.id].text) for task in tasks
    }


def closest(task: plan.Task, calls: Sequence[Call]) -> KnownMistake | None:
    """Return the known mistake whose answers agree with the student's in every call, or None.

    Of several mistakes, return the one with the smallest sum of differences. Answers that agree
    with the library, and no answers at all, are no mistake.
    """
    calls = [(args, kwargs, in_gauge(task.id, answer)) for args, kwargs, answer in calls]
    if all(answer is None for _, _, answer in calls):
        return None
    solution = plan.function(task)
    errors = []
    for args, kwargs, answer in calls:
        truth = in_gauge(task.id, call_quietly(solution, args, kwargs))
        errors.append(difference(answer, truth))
    if max(errors) <= ROUNDING:
        return None
    nearest = None
    smallest = np.inf
    for mistake in of_task(task):
        distance = _distance(mistake, calls, errors)
        if distance is not None and distance < smallest:
            nearest = mistake
            smallest = distance
    return nearest


def _inverse_responses(states: Any) -> list[Any]:
    """Return f^-1 of each state, divided by f^-1(128)."""
    curves = [state[0] if isinstance(state, tuple | list) else state for state in states]
    return [curve / curve[128] for curve in curves]


def _without_offset(solution: Any) -> tuple[Any, ...]:
    """Return g and lE, shifted together so that g is 0 in its middle."""
    g = solution[0]
    return tuple(part - g[len(g) // 2] for part in solution)


GAUGES: dict[str, Callable[[Any], Any]] = {
    "hat": lambda w: w / w.max(),
    "gsolve": _without_offset,
    "recover": lambda g: g - g[128],
    "recover_steps": _inverse_responses,
    "solve": lambda u: u - u.mean(),
}
# tasks that answer with one array, which a student may return as a list
ARRAY_TASKS = ("hat", "recover", "solve")


def in_gauge(task: str, answer: Any) -> Any:
    """Return an answer in the scale or gauge in which answers of this task are compared.

    An answer of a form that the task does not have is returned unchanged.
    """
    if task not in GAUGES:
        return answer
    try:
        array = compare.as_listed(answer) if task in ARRAY_TASKS else answer
        return GAUGES[task](array)
    except Exception:  # a student may return anything
        return answer


def _distance(
    mistake: KnownMistake, calls: Sequence[Call], errors: Sequence[float]
) -> float | None:
    """Return the sum of differences between the student's answers and a wrong function's.

    Return None if the two disagree in one of the calls. `errors` are the student's differences to
    the library.
    """
    total = 0.0
    for (args, kwargs, answer), error in zip(calls, errors, strict=True):
        wrong = in_gauge(mistake.task, call_quietly(mistake.function, args, kwargs))
        distance = difference(answer, wrong)
        if distance > max(ROUNDING, MAX_UNEXPLAINED * min(error, 1.0)):
            return None
        total += distance
    return total


def call_quietly(
    function: Callable[..., Any], args: Sequence[Any], kwargs: Mapping[str, Any]
) -> Any:
    """Return the answer of a trusted function as plain arrays, or None if it raises."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            return compare.plain(function(*args, **kwargs))
        except Exception:  # a wrong function may fail in any way
            return None


def difference(a: Any, b: Any) -> float:
    """Return the root mean square of a - b relative to that of b.

    Of an answer in several parts, return the largest difference of a part. Answers that cannot be
    compared differ by `MAX_DIFFERENCE`.

    Examples
    --------
    >>> difference(np.ones(4), np.ones(4)), difference((np.ones(4), 3.0), (np.ones(4), 2.0))
    (0.0, 0.5)
    """
    if isinstance(b, tuple | list):
        if not isinstance(a, tuple | list) or len(a) != len(b):
            return MAX_DIFFERENCE
        return max((difference(x, y) for x, y in zip(a, b, strict=True)), default=0.0)
    if a is None or b is None or isinstance(b, bytes | str):
        return 0.0 if type(a) is type(b) and a == b else MAX_DIFFERENCE
    if isinstance(a, tuple | list):
        a = compare.as_listed(a)
    if isinstance(a, tuple | list | dict):  # a ragged list stays one
        return MAX_DIFFERENCE
    a = np.asarray(a).squeeze()
    b = np.asarray(b).squeeze()
    if a.shape != b.shape or a.dtype.kind not in "biuf" or b.dtype.kind not in "biuf":
        return MAX_DIFFERENCE
    return _relative_rms(a.astype(np.float64), b.astype(np.float64))


def _relative_rms(a: F64, b: F64) -> float:
    """Return rms(a - b) / rms(b) over the finite values, at most `MAX_DIFFERENCE`."""
    finite = np.isfinite(a)
    if np.any(finite != np.isfinite(b)):
        return MAX_DIFFERENCE
    if not finite.any():
        return 0.0
    scale = np.sqrt(np.mean(b[finite] ** 2))
    error = np.sqrt(np.mean((a - b)[finite] ** 2))
    if scale > 0:
        return float(min(error / scale, MAX_DIFFERENCE))
    return 0.0 if error == 0 else MAX_DIFFERENCE
