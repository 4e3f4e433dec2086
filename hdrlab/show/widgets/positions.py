"""Where sliders can stand: every range becomes a list of values, and a position is an index into each list.

grids  name -> the values of one parameter, in the order of its slider
at     one index per parameter
"""

import inspect
import itertools
import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from hdrlab.errors import InputError

Grids = dict[str, list[Any]]


def values(grids: Grids, at: Sequence[int]) -> dict[str, Any]:
    """Return each parameter's value at a position."""
    return {name: each[k] for (name, each), k in zip(grids.items(), at, strict=True)}


def grid(name: str, given: Any) -> list[Any]:
    """Return the positions of one slider: the values of a list, or the steps of a range."""
    if not isinstance(given, tuple):
        each = list(given) if isinstance(given, Iterable) and not isinstance(given, str) else []
        if len(each) < 2:
            raise InputError(
                f"expected {name} as (low, high[, step]) or a list of values, got {given!r}"
            )
        return each
    low, high, step = (
        given if len(given) == 3 else (*given, None) if len(given) == 2 else (0, 0, None)
    )
    whole = all(isinstance(end, int | np.integer) for end in (low, high))
    step = step if step is not None else 1 if whole else (high - low) / 100
    if not (np.isfinite([low, high, step]).all() and low < high and 0 < step <= high - low):
        raise InputError(
            f"expected {name} as a range (low, high[, step]) with low < high, got {given!r}"
        )
    count = int(np.floor((high - low) / step + 1e-9)) + 1
    return [low + k * step for k in range(count)]


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
    numbers = all(isinstance(each, int | float | np.number) for each in [*grid, value])
    return int(np.argmin(np.abs(np.array(grid) - value))) if numbers else len(grid) // 2


def beforehand(grids: Grids, at: list[int], most: int) -> list[list[int]]:
    """Return the start, then every other position, or those of an even grid where they are more than `most`.

    A grid has the ends of each range; of the sliders the longest is thinned out first, and words
    last.
    """
    counts = list(map(len, grids.values()))
    words = [isinstance(each[0], str) for each in grids.values()]
    while math.prod(counts) > max(most, 1):
        counts[
            max(range(len(counts)), key=lambda k: (min(counts[k], 3), not words[k], counts[k]))
        ] -= 1
    axes = [
        _even(len(each), count, k)
        for each, count, k in zip(grids.values(), counts, at, strict=True)
    ]
    return sorted(map(list, itertools.product(*axes)), key=lambda position: position != at)


def _even(length: int, count: int, here: int) -> list[int]:
    """Return `count` positions from end to end, of which the one nearest to `here` is `here`."""
    chosen = np.linspace(0, length - 1, count).round().astype(int)
    chosen[np.argmin(np.abs(chosen - here))] = here
    return chosen.tolist()
