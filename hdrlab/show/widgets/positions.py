"""Slider positions: every range becomes a list of values, and a position is an index into each list.

grids      name -> the values of one parameter, in the order of its slider
position   one index per parameter
"""

import inspect
import itertools
import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from hdrlab.errors import InputError
from hdrlab.show.pictures import short

Grids = dict[str, list[Any]]


def values(grids: Grids, position: Sequence[int]) -> dict[str, Any]:
    """Return each parameter's value at a position."""
    pairs = zip(grids.items(), position, strict=True)
    return {name: grid_values[index] for (name, grid_values), index in pairs}


def grid(name: str, choices: Any) -> list[Any]:
    """Return the values of one slider: those of a list, or the steps of a range (low, high[, step])."""
    if isinstance(choices, tuple):
        return _steps_of_range(name, choices)
    is_list = isinstance(choices, Iterable) and not isinstance(choices, str)
    slider_values = list(choices) if is_list else []
    if len(slider_values) < 2:
        raise InputError(
            f"expected {name} as (low, high[, step]) or a list of values, got {choices!r}"
        )
    return slider_values


def _steps_of_range(name: str, ends: tuple[Any, ...]) -> list[Any]:
    """Return the steps of a range (low, high) or (low, high, step), both ends included."""
    wrong = f"expected {name} as a range (low, high[, step]) with low < high, got {ends!r}"
    if len(ends) not in (2, 3):
        raise InputError(wrong)
    low, high = ends[:2]
    step = ends[2] if len(ends) == 3 else None
    if step is None:
        has_whole_ends = all(isinstance(end, int | np.integer) for end in (low, high))
        step = 1 if has_whole_ends else (high - low) / 100
    is_finite = np.isfinite([low, high, step]).all()
    if not (is_finite and low < high and 0 < step <= high - low):
        raise InputError(wrong)
    rounding = 1e-9  # (high - low) / step may come out slightly below a whole number
    count = int(np.floor((high - low) / step + rounding)) + 1
    return [low + index * step for index in range(count)]


def caption_texts(name: str, grid: Sequence[Any], caption: str | None) -> tuple[str, list[str]]:
    """Return the words beside a slider, and the text of each of its values.

    Examples
    --------
    >>> caption_texts("f_number", [2.0, 2.8], "aperture f/{:g}")
    ('aperture', ['f/2', 'f/2.8'])
    >>> caption_texts("full_well", [1000], "full well {} electrons")
    ('full well', ['1000 electrons'])
    >>> caption_texts("span", [0, 1], "span {} frames on each side")
    ('span', ['0 frames on each side', '1 frame on each side'])
    >>> caption_texts("full_well", [1000], None)
    ('full_well', ['1000'])
    """
    if caption is None:
        return name, [short(value) for value in grid]
    words = caption.split(" ")
    places = [index for index, word in enumerate(words) if "{" in word]
    if len(places) != 1 or places == [0]:
        raise InputError(
            f"expected a caption of {name} with words before the value, such as "
            f"'{name} {{:g}} pixels', got {caption!r}"
        )
    label = " ".join(words[: places[0]])
    value_text = " ".join(words[places[0] :])
    return label, [_singular(value_text.format(value)) for value in grid]


def _singular(text: str) -> str:
    """Return "1 pixel" for "1 pixels"; other texts stay as they are."""
    number, _, unit = text.partition(" ")
    noun, space, rest = unit.partition(" ")
    is_plural = noun.endswith("s") and noun not in ("s", "times")
    if number.lstrip("+-") != "1" or not is_plural:
        return text
    return f"{number} {noun.removesuffix('s')}{space}{rest}"


def is_unordered(grid: Sequence[Any]) -> bool:
    """Return whether the values are names, such as operators; "1/60 s" or "f/8" are quantities.

    Examples
    --------
    >>> is_unordered(["reinhard", "durand"]), is_unordered(["1/60 s", "1/30 s"])
    (True, False)
    """
    return all(
        isinstance(value, str) and not any(letter.isdigit() for letter in value) for value in grid
    )


def start(f: Callable[..., Any], grids: Grids) -> list[int]:
    """Return the position nearest to each parameter's default, or the middle where it has none."""
    parameters = inspect.signature(f).parameters
    takes_any = any(p.kind is p.VAR_KEYWORD for p in parameters.values())
    unknown = [name for name in grids if name not in parameters and not takes_any]
    if unknown:
        known = ", ".join(parameters)
        raise InputError(f"expected parameters of the function, {known}; got {', '.join(unknown)}")
    return [
        _nearest(grid, getattr(parameters.get(name), "default", None))
        for name, grid in grids.items()
    ]


def _nearest(grid: list[Any], value: Any) -> int:
    if value in grid:
        return grid.index(value)
    has_numbers = all(isinstance(item, int | float | np.number) for item in [*grid, value])
    if not has_numbers:
        return len(grid) // 2
    return int(np.argmin(np.abs(np.array(grid) - value)))


def beforehand(grids: Grids, start: list[int], max_positions: int) -> list[list[int]]:
    """Return the positions whose figures are computed in advance, `start` first.

    These are all positions, or an even grid of at most `max_positions` that includes the ends of
    each range. The longest slider is thinned out first, sliders with words last.
    """
    lengths = [len(grid_values) for grid_values in grids.values()]
    has_words = [isinstance(grid_values[0], str) for grid_values in grids.values()]
    counts = lengths.copy()

    def thinning_order(slider: int) -> tuple[int, bool, int]:
        return min(counts[slider], 3), not has_words[slider], counts[slider]

    while math.prod(counts) > max(max_positions, 1):
        longest = max(range(len(counts)), key=thinning_order)
        counts[longest] -= 1
    axes = [
        _even_indices(length, count, index)
        for length, count, index in zip(lengths, counts, start, strict=True)
    ]
    positions = [list(position) for position in itertools.product(*axes)]
    return sorted(positions, key=lambda position: position != start)


def _even_indices(length: int, count: int, included: int) -> list[int]:
    """Return `count` indices from end to end; the nearest to `included` is replaced by it."""
    indices = np.linspace(0, length - 1, count).round().astype(int)
    indices[np.argmin(np.abs(indices - included))] = included
    return indices.tolist()
