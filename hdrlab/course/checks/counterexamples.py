"""Find the smallest input for which a student's function gives a wrong answer.

A check that fails draws its inputs again, with a public seed, and calls the library with them. The
student's function gets the same inputs in the sandbox. If one of its answers is wrong, this input is
made smaller (see shrinking.py) as long as the answer stays wrong.

So the counterexample never contains a number of the inputs that were drawn with the course's
secret, nor of a hidden check, and it is the same in `check()` and in `hdrlab grade`.

A file of checks may define:

is_valid_input(...)            whether the function is defined for these arguments
check_one_input(subject, ...)  compare the answer to these arguments as the checks do; without it, the
                               answer is compared with the solution's (see `differs`)
SMALL_INPUTS                   list of argument tuples which are tried in place of the inputs of the
                               checks, from small to large; for inputs with a structure, such as files.
                               A dictionary at the end of a tuple holds keyword arguments
check_one_input = None         no counterexamples: right answers may be too different
"""

import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np

from hdrlab.course.checks import compare, inprocess, misconceptions, shrinking, snippets
from hdrlab.course.checks.subject import NoAnswer

# draws of a check's inputs that are tried, with these seeds; `check()` uses the first one
PUBLIC_SEEDS = (0, 1)
# limits of one search: calls of the student's function, seconds that they take, and seconds of
# processor time that this process takes for the solution and the comparisons
MAX_CALLS = 1000
MAX_CALL_SECONDS = 5.0
MAX_OWN_CPU_SECONDS = 3.0
# calls of a check that are tried as a start
MAX_STARTS = 12
# a counterexample with more numbers explains nothing
MAX_NUMBERS = 40
# difference of two numbers, relative to the largest number of the right answer, that counts as wrong
WRONG_FRACTION = 0.002
# a right answer below it counts as 0
SMALLEST_ANSWER = 1e-6

Run = Callable[[Any, np.random.Generator], object]


class SearchEnded(Exception):
    """Raised inside the search if it may make no further calls."""


class NoCounterexample(Exception):
    """Raised if the search finds no counterexample; the message says why."""


@dataclass(frozen=True, kw_only=True)
class Counterexample:
    """An input, the student's answer and the right one, as text.

    Attributes
    ----------
    inputs : lines of code that set the inputs
    call : the call
    yours : what the student's function answers, or how it fails
    correct : what the solution answers
    """

    inputs: tuple[str, ...]
    call: str
    yours: str
    correct: str


@dataclass(frozen=True, kw_only=True)
class Trial:
    """A call whose answer is wrong: the input, the student's answer or failure, and the right answer."""

    args: tuple[Any, ...]
    kwargs: dict[str, Any]
    answer: Any
    failure: str
    truth: Any


class Search:
    """The search for one counterexample: what is compared with what, and how much of it is left.

    Parameters
    ----------
    task : str
    module : module
        The file of checks, with its optional `is_valid_input`, `check_one_input` and `SMALL_INPUTS`.
    subject : Subject
        The student's functions.
    solution : function
    raised : bool
        Whether the check failed because the function raised an exception. Only then an exception
        makes a counterexample.
    """

    def __init__(
        self,
        task: str,
        module: ModuleType,
        subject: Any,
        solution: Callable[..., Any],
        *,
        raised: bool,
    ) -> None:
        self._task = task
        self._subject = subject
        self._solution = solution
        self._raised = raised
        self._is_valid = getattr(module, "is_valid_input", None)
        self._check = getattr(module, "check_one_input", None)
        self._calls_left = MAX_CALLS
        self._call_seconds_left = MAX_CALL_SECONDS
        self._cpu_deadline = time.process_time() + MAX_OWN_CPU_SECONDS

    def try_input(self, args: Sequence[Any], kwargs: Mapping[str, Any]) -> Trial | None:
        """Return the call if its answer is wrong, or None. Raise SearchEnded if nothing is left."""
        if (
            self._calls_left <= 0
            or self._call_seconds_left <= 0
            or time.process_time() > self._cpu_deadline
        ):
            raise SearchEnded
        truth = self._right_answer(args, kwargs)
        if truth is None:
            return None
        self._calls_left -= 1
        answer = None
        failure = ""
        started = time.monotonic()
        self._subject.limit_check(self._call_seconds_left)
        try:
            answer, is_wrong = self._compare(args, kwargs, truth)
        except NoAnswer as error:
            if error.kind != "raised":
                raise SearchEnded from None
            is_wrong = self._raised
            failure = str(error)
        finally:
            self._subject.calls.clear()
            self._call_seconds_left -= time.monotonic() - started
        if not is_wrong or bool(failure) != self._raised:
            return None
        return Trial(
            args=tuple(args), kwargs=dict(kwargs), answer=answer, failure=failure, truth=truth
        )

    def _right_answer(self, args: Sequence[Any], kwargs: Mapping[str, Any]) -> Any:
        """Return the solution's answer, or None if it is empty, or if the input is not valid."""
        with warnings.catch_warnings(), np.errstate(divide="raise", over="raise", invalid="raise"):
            warnings.simplefilter("error")
            try:
                if self._is_valid is not None and not self._is_valid(*args, **kwargs):
                    return None
                if self._check is not None:
                    self._check(inprocess.Subject({self._task: self._solution}), *args, **kwargs)
                truth = compare.plain(self._solution(*deepcopy(args), **deepcopy(kwargs)))
            except Exception:  # whatever the solution refuses is no input
                return None
        is_empty = any(np.size(leaf) == 0 for _, leaf in shrinking.leaves(truth))
        return None if is_empty else truth

    def _compare(
        self, args: Sequence[Any], kwargs: Mapping[str, Any], truth: Any
    ) -> tuple[Any, bool]:
        """Return the student's answer, and whether it is wrong."""
        if self._check is None:
            answer = getattr(self._subject, self._task)(*args, **kwargs)
            array = answer
            if isinstance(truth, np.ndarray) and isinstance(answer, tuple | list):
                array = compare.as_listed(answer)
            gauged = misconceptions.in_gauge(self._task, array)
            return answer, differs(gauged, misconceptions.in_gauge(self._task, truth))
        is_wrong = False
        try:
            self._check(self._subject, *args, **kwargs)
        except NoAnswer:
            raise
        except AssertionError:
            is_wrong = True
        except Exception:  # an answer that cannot be compared says nothing
            is_wrong = False
        return self._subject.calls[-1].answer if self._subject.calls else None, is_wrong


def find(
    task: str,
    module: ModuleType,
    run: Run,
    subject: Any,
    solution: Callable[..., Any],
    *,
    raised: bool = False,
) -> Counterexample:
    """Return the smallest counterexample to a student's function that the search finds.

    Parameters
    ----------
    task : str
    module : module
        The file of checks.
    run : function
        Runs the check that failed on a subject with a random generator.
    subject : Subject
        The student's functions. The search starts them afresh.
    solution : function
        The right function.
    raised : bool
        Whether the check failed because the function raised an exception.

    Raises
    ------
    NoCounterexample
        If the search finds none.
    """
    if getattr(module, "check_one_input", True) is None:
        raise NoCounterexample("the file of checks has check_one_input = None")
    search = Search(task, module, subject, solution, raised=raised)
    subject.fresh()
    starts = _start_inputs(task, module, run, solution)
    smallest = None
    reason = "the function answers no public input of the check wrongly"
    try:
        for args, kwargs in starts:
            smallest = search.try_input(args, kwargs)
            if smallest is not None:
                break
        if smallest is not None and not hasattr(module, "SMALL_INPUTS"):
            for smaller in _shrink(search, smallest):
                smallest = smaller
    except SearchEnded:
        reason = "the search ended before the function answered an input wrongly"
    if smallest is None:
        raise NoCounterexample(reason)
    return _confirmed(task, module, subject, solution, smallest, raised=raised)


def _start_inputs(
    task: str, module: ModuleType, run: Run, solution: Callable[..., Any]
) -> Iterator[tuple[Sequence[Any], Mapping[str, Any]]]:
    """Yield the inputs with which the check calls the solution, small ones first."""
    if hasattr(module, "SMALL_INPUTS"):
        yield from small_inputs(module)
        return
    for seed in PUBLIC_SEEDS:
        subject = inprocess.Subject({task: solution})
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                run(subject, np.random.default_rng(seed))
            except Exception:  # a check that does not hold for the solution is broken
                return
        calls = sorted(subject.calls, key=lambda call: _count_numbers(call[:2]))
        for args, kwargs, _ in calls[:MAX_STARTS]:
            yield args, kwargs


def small_inputs(module: ModuleType) -> Iterator[tuple[Sequence[Any], Mapping[str, Any]]]:
    """Yield the arguments and the keyword arguments of each of the `SMALL_INPUTS` of a file of checks."""
    for args in module.SMALL_INPUTS:
        if isinstance(args[-1], dict):
            yield args[:-1], args[-1]
        else:
            yield args, {}


def _count_numbers(value: Any) -> int:
    return sum(np.size(leaf) for _, leaf in shrinking.leaves(value))


def _shrink(search: Search, first: Trial) -> Iterator[Trial]:
    """Yield calls with smaller and smaller inputs whose answers are wrong."""
    latest = first

    def holds(value: Any) -> bool:
        nonlocal latest
        trial = search.try_input(*value)
        if trial is not None:
            latest = trial
        return trial is not None

    for _ in shrinking.shrink((first.args, first.kwargs), holds):
        yield latest


def _confirmed(
    task: str,
    module: ModuleType,
    subject: Any,
    solution: Callable[..., Any],
    smallest: Trial,
    *,
    raised: bool,
) -> Counterexample:
    """Return the counterexample whose code, in a process of its own, gives the same wrong answer."""
    snippet = snippets.write(task, solution, smallest.args, smallest.kwargs)
    if snippet.count > MAX_NUMBERS:
        raise NoCounterexample(f"the smallest input has {snippet.count} numbers")
    search = Search(task, module, subject, solution, raised=raised)
    subject.fresh()
    try:
        trial = search.try_input(*snippet.arguments())
    except SearchEnded:
        raise NoCounterexample("the code of the input gives no answer in a new process") from None
    if trial is None or snippets.show(trial.answer) != snippets.show(smallest.answer):
        raise NoCounterexample("the code of the input gives another answer in a new process")
    call = snippet.call
    if trial.failure:
        return Counterexample(
            inputs=snippet.inputs,
            call=call,
            yours=trial.failure,
            correct=snippets.show(trial.truth),
        )
    if isinstance(trial.truth, list):
        # the states of a generator
        call = f"list({call})"
    call, answer, truth = _worst_part(call, trial.answer, trial.truth)
    return Counterexample(
        inputs=snippet.inputs,
        call=call,
        yours=snippets.show(answer),
        correct=snippets.show(truth),
    )


def _worst_part(call: str, answer: Any, truth: Any) -> tuple[str, Any, Any]:
    """Return the part of an answer that differs most, with the code that gives it, and the right one."""
    if isinstance(truth, tuple | list) and isinstance(answer, tuple | list):
        pairs = list(zip(answer, truth, strict=False))
        if pairs and len(answer) >= len(truth):
            errors = [_relative_error(a, b, 1.0) for a, b in pairs]
            k = int(np.argmax(errors))
            return _worst_part(f"{call}[{k}]", *pairs[k])
        return call, answer, truth
    if not isinstance(truth, np.ndarray) or not np.ndim(truth):
        return call, answer, truth
    array = compare.as_listed(answer) if isinstance(answer, tuple | list) else answer
    if not isinstance(array, np.ndarray) or array.shape != truth.shape:
        return call, answer, truth
    if truth.size <= snippets.MAX_SHOWN_NUMBERS:
        return call, array, truth
    if array is not answer:
        call = f"np.array({call})"
    error = np.abs(array.astype(np.float64) - truth.astype(np.float64))
    index = np.unravel_index(int(np.argmax(np.nan_to_num(error, nan=np.inf))), truth.shape)
    place = ", ".join(str(int(i)) for i in index)
    return f"{call}[{place}]", array[index], truth[index]


def differs(answer: Any, truth: Any) -> bool:
    """Return whether an answer is not the right one.

    Whole numbers and flags must be equal. Other numbers may differ by 0.2 % of the largest
    number of the right answer. Axes of length 1, and parts after those that are asked for, are free.
    """
    return _error(answer, truth) > WRONG_FRACTION


def _error(answer: Any, truth: Any) -> float:
    """Return the difference of two answers, relative to the right one; infinite for other forms."""
    numbers = [np.asarray(leaf) for _, leaf in shrinking.leaves(truth)]
    sizes = [np.abs(array[np.isfinite(array)]) for array in numbers if array.dtype.kind == "f"]
    scale = max((float(array.max(initial=0.0)) for array in sizes), default=0.0)
    return _relative_error(answer, truth, max(scale, SMALLEST_ANSWER))


def _relative_error(answer: Any, truth: Any, scale: float) -> float:
    """Return the largest difference of two answers in units of a scale; infinite for other forms."""
    if isinstance(truth, tuple | list):
        if isinstance(answer, np.ndarray) and answer.ndim:
            answer = list(answer)
        if not isinstance(answer, tuple | list) or len(answer) < len(truth):
            return np.inf
        if isinstance(truth, list) and len(answer) != len(truth):
            return np.inf
        pairs = zip(answer, truth, strict=False)
        return max((_relative_error(a, b, scale) for a, b in pairs), default=0.0)
    if truth is None or isinstance(truth, bytes | str):
        return 0.0 if type(answer) is type(truth) and answer == truth else np.inf
    if isinstance(answer, tuple | list):
        answer = compare.as_listed(answer)
    if not isinstance(answer, np.ndarray | np.generic | int | float):
        return np.inf
    values = np.asarray(answer).squeeze()
    right = np.asarray(truth).squeeze()
    if values.shape != right.shape or values.dtype.kind not in "biuf":
        return np.inf
    is_whole = right.dtype.kind in "biu"
    values = values.astype(np.float64)
    right = right.astype(np.float64)
    if is_whole:
        return 0.0 if np.array_equal(values, right) else np.inf
    is_known = np.isfinite(right)
    if not np.array_equal(is_known, np.isfinite(values)):
        return np.inf
    return float(np.abs(values - right)[is_known].max(initial=0.0) / scale)
