"""Recognise a known mistake: the answers agree with a wrong function, and not with the library.

The wrong functions of the course's tasks are in `hdrlab.course.checks.mistakes`. An instructor's
own task has a folder `mistakes` beside it. A wrong function answers the same questions as the
student did. Answers are compared after removing the scale or gauge that the checks leave free.

Real mistakes come in pairs, and a student's own code has details that no wrong function has. So a
mistake need not explain every answer: `diagnose` also names the one that explains all answers of a
check which fails, as long as no right answer contradicts it.

call        (arguments, keyword arguments, answer) of one call; the answer is None if there was none
difference  between two answers, relative: 0 is equal, 1 about as large as the answer itself
"""

import runpy
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
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
ROUNDING_ERROR = 1e-3
# part of the difference to the library that a wrong function may leave unexplained
MAX_UNEXPLAINED = 0.1
# the difference of answers that cannot be compared, such as two shapes
MAX_DIFFERENCE = 1e3
# calls of a task that are compared with every wrong function
MAX_COMPARED_CALLS = 20
# mistakes of a task that are named together
MAX_NAMED_MISTAKES = 2


@dataclass(frozen=True, kw_only=True)
class CheckedCalls:
    """The calls that a check made of a student's function, and whether the check holds."""

    calls: Sequence[Call]
    holds: bool


@dataclass(frozen=True, kw_only=True)
class ComparedCall:
    """A call, with its answer and the library's in a common gauge, and the difference of the two."""

    args: Sequence[Any]
    kwargs: dict[str, Any]
    answer: Any
    truth: Any
    error: float

    @property
    def is_right(self) -> bool:
        """Whether the answer agrees with the library's."""
        return self.error <= ROUNDING_ERROR


@dataclass(frozen=True, kw_only=True)
class Diagnosis:
    """The known mistakes that explain why checks of a task fail.

    Attributes
    ----------
    mistakes : the known mistakes, none if nothing is recognized
    explains_all : whether the first one explains all answers of all checks
    """

    mistakes: tuple[KnownMistake, ...] = ()
    explains_all: bool = False

    @property
    def sentence(self) -> str:
        """What the student reads about the mistakes."""
        return " ".join(mistake.sentence for mistake in self.mistakes)

    @property
    def costs_half_at_most(self) -> bool:
        """Whether the student keeps at least half of the task's points."""
        return self.explains_all and self.mistakes[0].costs_half_at_most


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
    return _closest(of_task(task), _compare_with_solution(task, calls))


def diagnose(task: plan.Task, checks: Sequence[CheckedCalls]) -> Diagnosis:
    """Return the known mistakes that explain why checks of a task fail.

    If a mistake explains all answers of all checks, return it alone. Otherwise, return those that
    explain all answers of a check that fails. A mistake is ruled out by a right answer to a call
    that it would have answered wrongly, and by other wrong answers than its own in more checks than
    it explains. If two mistakes explain a check equally well, none is named for this check.
    """
    failed: list[list[ComparedCall]] = []
    calls: list[ComparedCall] = []
    for check in checks:
        room = MAX_COMPARED_CALLS - len(calls)
        compared = _compare_with_solution(task, check.calls[:room])
        calls += compared
        is_answered = bool(compared) and all(call.answer is not None for call in compared)
        if not check.holds and is_answered:
            failed.append(compared)
    alone = _closest(of_task(task), calls)
    if alone is not None:
        return Diagnosis(mistakes=(alone,), explains_all=True)
    return Diagnosis(mistakes=_explain_checks(of_task(task), failed, calls))


def _compare_with_solution(task: plan.Task, calls: Sequence[Call]) -> list[ComparedCall]:
    """Return the calls with the answers in a common gauge, and their differences to the library's."""
    solution = plan.function(task)
    compared = []
    for args, kwargs, answer in calls:
        in_common_gauge = in_gauge(task.id, answer)
        truth = in_gauge(task.id, call_quietly(solution, args, kwargs))
        error = difference(in_common_gauge, truth)
        compared.append(
            ComparedCall(args=args, kwargs=kwargs, answer=in_common_gauge, truth=truth, error=error)
        )
    return compared


def _closest(
    mistakes: Sequence[KnownMistake], calls: Sequence[ComparedCall]
) -> KnownMistake | None:
    """Return the mistake that explains all calls with the smallest difference, or None."""
    if all(call.answer is None for call in calls):
        return None
    if all(call.is_right for call in calls):
        return None
    nearest = None
    smallest = np.inf
    for mistake in mistakes:
        distance = _distance(mistake, calls)
        if distance is not None and distance < smallest:
            nearest = mistake
            smallest = distance
    return nearest


def _explain_checks(
    mistakes: Sequence[KnownMistake],
    failed: Sequence[Sequence[ComparedCall]],
    calls: Sequence[ComparedCall],
) -> tuple[KnownMistake, ...]:
    """Return the mistakes that explain all answers of a check, of the checks that fail.

    `calls` are those of all checks. The right ones among them rule out mistakes.
    """
    right_calls = [call for call in calls if call.is_right]
    # distances of each mistake that is possible to the answers of the checks that it explains
    explained: dict[str, dict[int, float]] = {}
    for mistake in mistakes:
        distances = {}
        for place, compared in enumerate(failed):
            distance = _distance(mistake, compared)
            if distance is not None and any(_is_evidence(call) for call in compared):
                distances[place] = distance
        if not distances or _distance(mistake, right_calls) is None:
            continue
        others = [compared for place, compared in enumerate(failed) if place not in distances]
        contradicting = sum(_is_contradicted(mistake, compared) for compared in others)
        if contradicting <= len(distances):
            explained[mistake.name] = distances
    names: list[str] = []
    for place in range(len(failed)):
        candidates = [name for name, distances in explained.items() if place in distances]
        candidates.sort(key=lambda name: (-len(explained[name]), explained[name][place]))
        if not candidates or candidates[0] in names:
            continue
        if len(candidates) == 1 or not _is_as_good(explained, candidates[1], candidates[0], place):
            names.append(candidates[0])
    by_name = {mistake.name: mistake for mistake in mistakes}
    return tuple(by_name[name] for name in names[:MAX_NAMED_MISTAKES])


def _is_evidence(call: ComparedCall) -> bool:
    """Return whether a wrong answer says which mistake led to it; a constant array does not."""
    if call.is_right:
        return False
    is_array = isinstance(call.answer, np.ndarray) and call.answer.size > 1
    return not is_array or bool(np.any(call.answer != call.answer.flat[0]))


def _is_contradicted(mistake: KnownMistake, calls: Sequence[ComparedCall]) -> bool:
    """Return whether a mistake would have given wrong answers, but others than the student's."""
    for call in calls:
        answer = in_gauge(mistake.task, call_quietly(mistake.function, call.args, call.kwargs))
        if difference(answer, call.truth) > ROUNDING_ERROR and not _agrees(call, answer):
            return True
    return False


def _agrees(call: ComparedCall, answer: Any) -> bool:
    """Return whether a wrong answer in the common gauge explains the student's."""
    return difference(call.answer, answer) <= _tolerance(call)


def _tolerance(call: ComparedCall) -> float:
    """Return the difference that a wrong function may have to the student's answer."""
    return max(ROUNDING_ERROR, MAX_UNEXPLAINED * min(call.error, 1.0))


def _is_as_good(
    explained: Mapping[str, Mapping[int, float]], other: str, best: str, place: int
) -> bool:
    """Return whether a mistake explains as many checks as the best one, and this one as well."""
    if len(explained[other]) < len(explained[best]):
        return False
    return explained[other][place] - explained[best][place] <= ROUNDING_ERROR


def _inverse_responses(states: Any) -> list[Any]:
    """Return f^-1 of each state, divided by f^-1(128)."""
    curves = [state[0] if isinstance(state, tuple | list) else state for state in states]
    return [curve / curve[128] for curve in curves]


def _without_offset(solution: Any) -> tuple[Any, ...]:
    """Return g and lE, shifted together so that g is 0 in its middle."""
    g = solution[0]
    return tuple(part - g[len(g) // 2] for part in solution)


def _inside(W: Any) -> Any:
    """Return weights without the outermost pixels, where the image may be extended in any way."""
    return W[1:-1, 1:-1]


GAUGES: dict[str, Callable[[Any], Any]] = {
    "hat": lambda w: w / w.max(),
    "gsolve": _without_offset,
    "recover": lambda g: g - g[128],
    "recover_steps": _inverse_responses,
    "solve": lambda u: u - u.mean(),
    "weight": _inside,
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


def _distance(mistake: KnownMistake, calls: Sequence[ComparedCall]) -> float | None:
    """Return the sum of differences between the student's answers and a wrong function's.

    Return None if the two disagree in one of the calls.
    """
    total = 0.0
    for call in calls:
        answer = call_quietly(mistake.function, call.args, call.kwargs)
        distance = difference(call.answer, in_gauge(mistake.task, answer))
        if distance > _tolerance(call):
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
