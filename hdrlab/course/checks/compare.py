"""Comparing an answer with what was expected, and remembering both, so that the difference can be drawn.

came      what a student's function answered: the plain arrays that the channel built, and nothing else
expected  what the specification says it should be

Asked in this order: answered, a kind of number, shape, finite, and at last `error <= tolerance`,
which a NaN does not pass.
"""

from collections.abc import Iterator
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Kind = Literal["image", "curve", "values"]
# of the check that runs: forms that were accepted, though the sheet asks for another
notes: list[str] = []


class Different(AssertionError):
    """An answer that is not what was expected; `expected` and `came` are arrays of one shape, or None."""

    def __init__(
        self,
        message: str,
        *,
        expected: Array | None = None,
        came: Array | None = None,
        kind: Kind = "values",
    ) -> None:
        super().__init__(message)
        self.message, self.expected, self.came, self.kind = message, expected, came, kind


def points(n: float, *, needs: str = "") -> Any:
    """Mark a check: what its promise is worth, 1 otherwise, and the one without which it earns nothing."""
    import pytest  # which is there where checks run, and slow to import elsewhere

    return pytest.mark.points(n, needs=needs)


def require(holds: Any, said: str, **remembered: Any) -> None:
    """Raise Different, with what is said and remembered, where something does not hold."""
    if not holds:
        raise Different(said, **remembered)


def numbers(came: Any, *, what: str = "the answer") -> Array:
    """Return an answer as an array of numbers, or raise Different that says what came instead."""
    require(came is not None, f"{what}: expected numbers, and nothing came (None)")
    if isinstance(came, tuple | list):
        came = as_listed(came, what)
    one = not isinstance(came, tuple | list | str | bytes | dict)
    require(one, f"{what}: expected one array of numbers, got {_named(came)}")
    array = np.asarray(came)
    require(array.dtype.kind in "biuf", f"{what}: expected real numbers, got dtype {array.dtype}")
    return array


def as_listed(came: Any, what: str = "the answer") -> Any:
    """Return a list of numbers, or of lists of them, as an array; what is no such list as it is."""
    try:
        array = np.array(came)
    except ValueError:  # ragged, or of no numbers
        return came
    if not array.size or array.dtype.kind not in "biuf":
        return came
    notes.append(f"{what}: {_named(came)} was taken for an array of shape {array.shape}")
    return array


def as_shape(array: Array, shape: tuple[int, ...], what: str = "the answer") -> Array:
    """Return an array of that shape if its own differs by axes of length 1 alone, or raise Different."""
    if array.shape == shape:
        return array
    if [n for n in array.shape if n > 1] != [n for n in shape if n > 1] or not array.size:
        raise Different(f"{what}: expected shape {shape}, got shape {array.shape}")
    notes.append(f"{what}: shape {array.shape} was taken for {shape}")
    return array.reshape(shape)


def parts(came: Any, count: int, *, what: str = "the answer") -> tuple[Any, ...]:
    """Return the first `count` parts of an answer of several, or raise Different."""
    several = isinstance(came, tuple | list) and len(came) >= count
    require(several, f"{what}: expected {count} things, got {_named(came)}")
    return tuple(came[:count])


def states(came: Any, *, what: str = "the steps") -> list[Any]:
    """Return what a generator yielded, at least one state, or raise Different."""
    yielded = isinstance(came, list | tuple) and len(came)
    require(yielded, f"{what}: expected a generator that yields states, got {_named(came)}")
    return list(came)


def same(
    came: Any,
    expected: Any,
    tolerance: float,
    *,
    what: str = "the answer",
    kind: Kind | None = None,
    picture: bool = False,
    where: Any = None,
) -> Array:
    """Return the answer as an array if it is what was expected within `tolerance`, or raise Different.

    Parameters
    ----------
    came, expected : arrays or numbers; a NaN that is expected must come as one
    tolerance : the largest difference of a value that is still the same, in the unit of the values
    what : the answer's name in the message
    kind : how to draw it; by default a curve for (n,), values for all else
    picture : the same as kind="image"
    where : mask; values elsewhere may be anything
    """
    wanted = np.asarray(expected)
    kind = (
        "image"
        if picture
        else kind or ("curve" if wanted.ndim == 1 and wanted.size > 8 else "values")
    )
    array = as_shape(numbers(came, what=what), wanted.shape, what)
    asked = np.ones(wanted.shape, bool) if where is None else np.broadcast_to(where, wanted.shape)
    values, truth = array.astype(np.float64), wanted.astype(np.float64)
    unknown = np.isnan(truth)
    both: dict[str, Any] = {"expected": wanted, "came": array, "kind": kind}
    _require_finite(values[asked & ~unknown], what, **both)
    count = np.count_nonzero(~np.isnan(values[asked & unknown]))
    require(
        not count,
        f"{what}: expected NaN where nothing is known, got numbers at {count} places",
        **both,
    )
    error = np.where(asked & ~unknown, np.abs(values - truth), 0.0)
    if not error.max(initial=0.0) <= tolerance:
        at = np.unravel_index(int(np.argmax(error)), error.shape)
        place = f" at {tuple(int(i) for i in at)}" if error.ndim else ""
        allowed = f"; the difference may be {tolerance:.2g}" if tolerance else ""
        off = (
            f"; {np.count_nonzero(error > tolerance)} of {error.size} values are off"
            if error.ndim
            else ""
        )
        message = f"{what}: expected {truth[at]:.6g}{place}, got {values[at]:.6g}{allowed}{off}"
        raise Different(message, **both)
    return array


def finite(came: Any, shape: tuple[int, ...], *, what: str = "the answer") -> Array:
    """Return an answer of which only the shape is known beforehand, if it is finite, or raise Different."""
    array = as_shape(numbers(came, what=what), shape, what)
    _require_finite(array.astype(np.float64), what)
    return array


def _require_finite(values: Array, what: str, **remembered: Any) -> None:
    """Raise Different where a value is NaN or infinite."""
    bad = np.count_nonzero(~np.isfinite(values))
    require(
        not bad, f"{what}: expected finite numbers, got {bad} NaN or infinite ones", **remembered
    )


def _named(came: Any) -> str:
    """Return what came, in few words, and never by asking the thing itself."""
    if came is None:
        return "nothing (None)"
    if isinstance(came, tuple | list | bytes | str):
        return f"{type(came).__name__} of {len(came)}"
    return (
        "one array" if isinstance(came, np.ndarray | np.generic | int | float) else "something else"
    )


def plain(answer: Any) -> Any:
    """Return an answer of trusted code as the channel brings those of students: arrays, tuples, lists.

    A NamedTuple becomes a tuple, what a generator yields a list; a number becomes an array without
    axes.
    """
    if answer is None or isinstance(answer, bytes | str):
        return answer
    if isinstance(answer, tuple):
        return tuple(plain(one) for one in answer)
    if isinstance(answer, Iterator | list):
        return [plain(one) for one in answer]
    return np.array(answer)
