"""Make the input of a function smaller as long as something still holds of it, such as a wrong answer.

An input is a list or a tuple of arguments. What may become smaller:

axes    axes of equal length are one dimension, such as the frames of `images` (P, H, W) and `times`
        (P,); rows are removed from all of them at once. A table of 256 levels keeps its length, and
        so do the three channels of a color image.
items   of a list
values  become 0, 1, or rounder. They stay between the smallest and the largest value that the array
        had at the start, so that weights stay positive, and levels stay within 0 and 255.

The search is greedy, as in delta debugging (Zeller and Hildebrandt, 2002): it tries to remove the half
of something, then the quarters, and at last single rows. It ends where nothing more can be removed.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

# an axis of that length holds something for each level of an 8-bit photo
LEVEL_COUNT = 256
CHANNEL_COUNT = 3
# an array with more values is simplified in blocks only, and one with still more as a whole only
MAX_SINGLE_VALUES = 24
MAX_BLOCK_VALUES = 1024
# whole numbers that an argument such as n may become
SMALL_NUMBERS = (2, 3, 4, 5, 6, 8, 12, 16, 32)

Path = tuple[int | str, ...]
Holds = Callable[[Any], bool]


@dataclass(frozen=True)
class Axis:
    """An axis of an array of the input."""

    path: Path
    number: int


def shrink(value: Any, holds: Holds) -> Iterator[Any]:
    """Yield smaller and smaller inputs of which `holds` is true, until none is smaller.

    Parameters
    ----------
    value : list or tuple
        The input, of which `holds` is true.
    holds : function
        Whether an input still is what is searched for. It may raise an exception to end the search.
    """
    ways = _ways(value)
    smallest = value
    is_smaller = True
    while is_smaller:
        is_smaller = False
        for way in ways:
            for smaller in _descend(smallest, way, holds):
                smallest = smaller
                is_smaller = True
                yield smallest


def simpler_inputs(value: Any) -> Iterator[Any]:
    """Yield the inputs that are one step smaller or simpler than an input."""
    for way in _ways(value):
        yield from way(value)


def _ways(value: Any) -> list[Callable[[Any], Iterator[Any]]]:
    """Return the ways to make an input smaller. Each takes an input, and yields smaller ones."""
    ranges = {path: _range(leaf) for path, leaf in leaves(value)}
    dimensions = _dimensions(value)
    return [
        _without_items,
        partial(_without_rows, dimensions=dimensions),
        partial(_with_simple_arrays, ranges=ranges),
        _with_simple_numbers,
    ]


def _descend(value: Any, candidates: Callable[[Any], Iterator[Any]], holds: Holds) -> Iterator[Any]:
    """Yield the first candidate that holds, then the first of this one's candidates, and so on."""
    is_smaller = True
    while is_smaller:
        is_smaller = False
        for candidate in candidates(value):
            if holds(candidate):
                value = candidate
                is_smaller = True
                yield value
                break


def leaves(value: Any, path: Path = ()) -> Iterator[tuple[Path, Any]]:
    """Yield each array, number or text of an input, with the indices that lead to it."""
    if isinstance(value, dict):
        for name, item in value.items():
            yield from leaves(item, (*path, name))
    elif isinstance(value, list | tuple):
        for k, item in enumerate(value):
            yield from leaves(item, (*path, k))
    else:
        yield path, value


def _lists(value: Any, path: Path = ()) -> Iterator[tuple[Path, list[Any]]]:
    """Yield each list of an input, with the indices that lead to it."""
    if isinstance(value, list):
        yield path, value
    if isinstance(value, dict):
        for name, item in value.items():
            yield from _lists(item, (*path, name))
    elif isinstance(value, list | tuple):
        for k, item in enumerate(value):
            yield from _lists(item, (*path, k))


def replace_at(value: Any, path: Path, new: Any) -> Any:
    """Return an input with something else at a path."""
    if not path:
        return new
    step, *rest = path
    if isinstance(value, dict):
        return value | {step: replace_at(value[step], tuple(rest), new)}
    items = list(value)
    items[step] = replace_at(items[step], tuple(rest), new)  # type: ignore[index]
    # a NamedTuple becomes a tuple, as on its way to the student's function
    return tuple(items) if isinstance(value, tuple) else items


def _arrays(value: Any) -> dict[Path, np.ndarray]:
    return {path: leaf for path, leaf in leaves(value) if isinstance(leaf, np.ndarray)}


def _range(leaf: Any) -> tuple[Any, Any] | None:
    """Return the smallest and the largest value of an array of real numbers."""
    if not isinstance(leaf, np.ndarray) or leaf.dtype.kind not in "biuf" or not leaf.size:
        return None
    low = np.nanmin(leaf)
    high = np.nanmax(leaf)
    return low, np.ceil(high) if leaf.dtype.kind == "f" else high


def _dimensions(value: Any) -> list[list[Axis]]:
    """Return the axes of all arrays, those of equal length together, the longest first."""
    axes: dict[int, list[Axis]] = {}
    for path, array in _arrays(value).items():
        for number, length in enumerate(array.shape):
            is_table = number == 0 and length == LEVEL_COUNT
            is_channels = number > 0 and number == array.ndim - 1 and length == CHANNEL_COUNT
            if not is_table and not is_channels:
                axes.setdefault(length, []).append(Axis(path, number))
    return [axes[length] for length in sorted(axes, reverse=True)]


def _blocks(length: int) -> Iterator[slice]:
    """Yield the halves of a range, then the quarters, and so on, down to single places."""
    size = max(1, length // 2)
    while True:
        for start in range(0, length, size):
            yield slice(start, start + size)
        if size == 1:
            return
        size //= 2


def _without_items(value: Any) -> Iterator[Any]:
    """Yield the input without some of the items of a list."""
    for path, items in _lists(value):
        for block in _blocks(len(items)):
            shorter = items[: block.start] + items[block.stop :]
            if shorter:
                yield replace_at(value, path, shorter)


def _without_rows(value: Any, dimensions: list[list[Axis]]) -> Iterator[Any]:
    """Yield the input with some rows removed from all axes of a dimension."""
    for axes in dimensions:
        arrays = _arrays(value)
        present = [axis for axis in axes if axis.path in arrays]
        lengths = {arrays[axis.path].shape[axis.number] for axis in present}
        if len(lengths) != 1 or lengths == {1}:
            continue
        for block in _blocks(lengths.pop()):
            shorter = value
            for axis in present:
                array = _arrays(shorter)[axis.path]
                shorter = replace_at(shorter, axis.path, np.delete(array, block, axis.number))
            if all(array.size for array in _arrays(shorter).values()):
                yield shorter


def _with_simple_arrays(value: Any, ranges: dict[Path, tuple[Any, Any] | None]) -> Iterator[Any]:
    """Yield the input with simpler values in one of the arrays."""
    for path, array in _arrays(value).items():
        span = ranges.get(path)
        if span is None:
            continue
        low, high = span
        complexity = _complexity(array)
        for simpler in _simpler(array, low, high):
            is_inside = bool(np.all((simpler >= low) & (simpler <= high) | np.isnan(simpler)))
            if is_inside and _complexity(simpler) < complexity:
                yield replace_at(value, path, simpler)


def _simpler(array: np.ndarray, low: Any, high: Any) -> Iterator[np.ndarray]:
    """Yield arrays of the same shape and type, of which some have simpler values."""
    if array.ndim == 1 and array.size > MAX_SINGLE_VALUES:
        for table in simple_tables(array):
            if low <= table.min() and table.max() <= high:
                yield table.astype(array.dtype)
    flat = array.ravel()
    blocks = [slice(0, array.size)]
    if not _is_curve(array) and array.size <= MAX_BLOCK_VALUES:
        blocks += _blocks(array.size)
    for block in blocks:
        for number in (0, 1):
            if low <= number <= high:
                yield _with(array, block, number)
    if array.dtype.kind == "f":
        for digits in (0, 1, 2):
            yield np.round(array, digits)
    if array.size > MAX_SINGLE_VALUES:
        return
    for k in range(array.size):
        for simpler in _simpler_numbers(flat[k].item()):
            if low <= simpler <= high:
                yield _with(array, k, simpler)


def _is_curve(array: np.ndarray) -> bool:
    """Return whether an array holds a real number for each level, such as a response curve."""
    if array.dtype.kind != "f":
        return False
    is_long = array.ndim == 1 and array.size > MAX_SINGLE_VALUES
    return is_long or (array.ndim == 2 and len(array) == LEVEL_COUNT)


def _with(array: np.ndarray, where: int | slice, number: float) -> np.ndarray:
    """Return an array with a number at some of its places, counted row by row."""
    changed = array.ravel().copy()
    changed[where] = number
    return changed.reshape(array.shape)


def simple_tables(array: np.ndarray) -> list[np.ndarray]:
    """Return tables (n,) that a reader knows: whole numbers from 0, a line from 0 to 1, and a tent."""
    z = np.arange(len(array))
    tables = [z, np.linspace(0, 1, len(array)), np.minimum(z, len(array) - 1 - z)]
    return tables if array.dtype.kind == "f" else tables[::2]


def _complexity(array: np.ndarray) -> tuple[int, int]:
    """Return how much there is to read in the values of an array: that of zeros is smallest."""
    if array.ndim == 1 and array.size > MAX_SINGLE_VALUES:
        for rank, table in enumerate(simple_tables(array)):
            if np.array_equal(array, table.astype(array.dtype)):
                return 0, rank + 2
    values, counts = np.unique(array, return_counts=True)
    others = int(array.size - counts.max())
    if array.dtype.kind in "bu" or array.dtype.kind == "i":
        lengths = np.ceil(np.log2(1 + np.abs(array.astype(np.float64)))).sum()
        return others + (len(values) > 1), int(lengths)
    length = sum(_written_length(number) for number in array.ravel()[: 4 * LEVEL_COUNT])
    return others + (len(values) > 1), length


def _written_length(number: Any) -> int:
    """Return how long a number is on paper; 0 has the length 0, and 1 the length 1."""
    if number == 0:
        return 0
    text = str(number).lstrip("-").removesuffix(".0")
    return len(text) if number == np.round(number) else 1 + len(text)


def _simpler_numbers(number: float) -> Iterator[float]:
    """Yield numbers that are simpler to read than a number: 0, 1, 2, and rounded ones."""
    if not np.isfinite(number):
        return
    yield from (0, 1, 2, 3)
    if isinstance(number, int):
        yield from (number // 100, number // 10, number // 2, number - 1)
        return
    for digit_count in (1, 2):
        yield float(f"{number:.{digit_count}g}")


def _with_simple_numbers(value: Any) -> Iterator[Any]:
    """Yield the input with a simpler number in place of one that is no array."""
    for path, leaf in leaves(value):
        if isinstance(leaf, bool | np.ndarray | np.bool):
            continue
        if isinstance(leaf, int | np.integer):
            for number in SMALL_NUMBERS:
                if number < leaf:
                    yield replace_at(value, path, type(leaf)(number))
        elif isinstance(leaf, float | np.floating) and np.isfinite(leaf):
            for digits in (1, 2, 3):
                rounded = float(f"{float(leaf):.{digits}g}")
                if len(repr(rounded)) < len(repr(float(leaf))):
                    yield replace_at(value, path, rounded)
