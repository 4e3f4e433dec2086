"""Compare an answer with what is expected, and keep both so that the difference can be drawn.

answer    that of a student's function: plain arrays that the channel built, and nothing else
expected  what the specification says it should be

The order of the comparison: is there an answer, is it numbers, shape, finite, and at last
`error <= tolerance`, which a NaN does not pass.
"""

from collections.abc import Iterator
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Kind = Literal["image", "curve", "values"]
# fewer values than that are shown as numbers, not as a curve
MIN_CURVE_VALUES = 9
# of the running check: forms of answers that were accepted, though the sheet asks for another
notes: list[str] = []


class AnswerMismatch(AssertionError):
    """An answer is not what is expected.

    Attributes
    ----------
    message : what differs
    expected, answer : arrays of the same shape, or None
    kind : how to draw the two
    """

    def __init__(
        self,
        message: str,
        *,
        expected: Array | None = None,
        answer: Array | None = None,
        kind: Kind = "values",
    ) -> None:
        super().__init__(message)
        self.message = message
        self.expected = expected
        self.answer = answer
        self.kind = kind


# the old name, which checks of instructors' own tasks may import
Different = AnswerMismatch


def points(n: float, *, needs: str = "") -> Any:
    """Mark a check: the points of its promise, and the check without which it earns nothing."""
    import pytest  # slow to import, and needed only where checks run

    return pytest.mark.points(n, needs=needs)


def require(condition: Any, message: str, **details: Any) -> None:
    """Raise AnswerMismatch with the message and details if a condition does not hold."""
    if not condition:
        raise AnswerMismatch(message, **details)


def numbers(answer: Any, *, what: str = "the answer") -> Array:
    """Return an answer as an array of real numbers, or raise AnswerMismatch."""
    require(answer is not None, f"{what}: expected numbers, got None; return the result")
    if isinstance(answer, tuple | list):
        answer = as_listed(answer, what)
    is_one_array = not isinstance(answer, tuple | list | str | bytes | dict)
    require(is_one_array, f"{what}: expected one array of numbers, got {_describe(answer)}")
    array = np.asarray(answer)
    require(array.dtype.kind in "biuf", f"{what}: expected real numbers, got dtype {array.dtype}")
    return array


def as_listed(answer: Any, what: str = "the answer") -> Any:
    """Return a list of numbers, nested or not, as an array, and anything else unchanged."""
    try:
        array = np.array(answer)
    except ValueError:  # a ragged list
        return answer
    if not array.size or array.dtype.kind not in "biuf":
        return answer
    notes.append(f"{what}: {_describe(answer)} was taken for an array of shape {array.shape}")
    return array


def as_shape(array: Array, shape: tuple[int, ...], what: str = "the answer") -> Array:
    """Return an array in a shape that differs by axes of length 1 at most, or raise AnswerMismatch."""
    if array.shape == shape:
        return array
    long_axes = [n for n in array.shape if n > 1]
    expected_long_axes = [n for n in shape if n > 1]
    if long_axes != expected_long_axes or not array.size:
        raise AnswerMismatch(f"{what}: expected shape {shape}, got shape {array.shape}")
    notes.append(f"{what}: shape {array.shape} was taken for {shape}")
    return array.reshape(shape)


def parts(answer: Any, count: int, *, what: str = "the answer") -> tuple[Any, ...]:
    """Return the first `count` parts of an answer in several parts, or raise AnswerMismatch.

    One array with `count` rows is taken for its rows.
    """
    if isinstance(answer, np.ndarray) and answer.ndim > 0 and len(answer) == count:
        notes.append(f"{what}: an array of shape {answer.shape} was taken for {count} parts")
        answer = tuple(answer)
    has_parts = isinstance(answer, tuple | list) and len(answer) >= count
    require(has_parts, f"{what}: expected {count} parts, got {_describe(answer)}")
    return tuple(answer[:count])


def states(answer: Any, *, what: str = "the steps") -> list[Any]:
    """Return the states that a generator yielded, at least one, or raise AnswerMismatch."""
    has_states = isinstance(answer, list | tuple) and len(answer) > 0
    require(has_states, f"{what}: expected a generator that yields states, got {_describe(answer)}")
    return list(answer)


def same(
    answer: Any,
    expected: Any,
    tolerance: float,
    *,
    what: str = "the answer",
    kind: Kind | None = None,
    picture: bool = False,
    where: Any = None,
) -> Array:
    """Return the answer as an array if it is as expected within `tolerance`, or raise AnswerMismatch.

    Parameters
    ----------
    answer, expected : arrays or numbers; where NaN is expected, the answer must be NaN
    tolerance : the largest difference of a value that is still the same, in the unit of the values
    what : the answer's name in the message
    kind : how to draw it; by default a curve for (n,), values for all else
    picture : the same as kind="image"
    where : mask; values elsewhere may be anything
    """
    wanted = np.asarray(expected)
    array = as_shape(numbers(answer, what=what), wanted.shape, what)
    compared = np.broadcast_to(True if where is None else where, wanted.shape)
    values = array.astype(np.float64)
    truth = wanted.astype(np.float64)
    unknown = np.isnan(truth)
    details: dict[str, Any] = {
        "expected": wanted,
        "answer": array,
        "kind": _kind(wanted, kind, picture=picture),
    }
    _require_finite(values[compared & ~unknown], what, **details)
    count = np.count_nonzero(~np.isnan(values[compared & unknown]))
    require(
        not count,
        f"{what}: expected NaN where nothing is known, got numbers at {count} places",
        **details,
    )
    error = np.where(compared & ~unknown, np.abs(values - truth), 0.0)
    if not error.max(initial=0.0) <= tolerance:
        message = _largest_error(error, values, truth, tolerance)
        raise AnswerMismatch(f"{what}: {message}", **details)
    return array


def _kind(expected: Array, kind: Kind | None, *, picture: bool) -> Kind:
    """Return how to draw an answer."""
    if picture:
        return "image"
    if kind is not None:
        return kind
    is_curve = expected.ndim == 1 and expected.size >= MIN_CURVE_VALUES
    return "curve" if is_curve else "values"


def _largest_error(error: Array, values: Array, truth: Array, tolerance: float) -> str:
    """Return a message about the value with the largest error."""
    index = np.unravel_index(int(np.argmax(error)), error.shape)
    place = ""
    wrong_values = ""
    if error.ndim:
        place = f" at {tuple(int(i) for i in index)}"
        wrong_values = f"; {np.count_nonzero(error > tolerance)} of {error.size} values are off"
    allowed = f"; the difference may be {tolerance:.2g}" if tolerance else ""
    return f"expected {truth[index]:.6g}{place}, got {values[index]:.6g}{allowed}{wrong_values}"


def finite(answer: Any, shape: tuple[int, ...], *, what: str = "the answer") -> Array:
    """Return a finite answer of which only the shape is known beforehand, or raise AnswerMismatch."""
    array = as_shape(numbers(answer, what=what), shape, what)
    _require_finite(array.astype(np.float64), what)
    return array


def _require_finite(values: Array, what: str, **details: Any) -> None:
    """Raise AnswerMismatch if a value is NaN or infinite."""
    bad = np.count_nonzero(~np.isfinite(values))
    require(not bad, f"{what}: expected finite numbers, got {bad} NaN or infinite ones", **details)


def _describe(answer: Any) -> str:
    """Return the kind of an answer in a few words, without calling any of its methods."""
    if answer is None:
        return "nothing (None)"
    if isinstance(answer, tuple | list | bytes | str):
        return f"{type(answer).__name__} of {len(answer)}"
    if isinstance(answer, np.ndarray | np.generic | int | float):
        return "one array"
    return "something else"


def plain(answer: Any) -> Any:
    """Return an answer of trusted code in the form in which the channel brings those of students.

    A NamedTuple becomes a tuple, a generator a list of what it yields, and a number an array
    without axes.
    """
    if answer is None or isinstance(answer, bytes | str):
        return answer
    if isinstance(answer, tuple):
        return tuple(plain(part) for part in answer)
    if isinstance(answer, Iterator | list):
        return [plain(part) for part in answer]
    return np.array(answer)
