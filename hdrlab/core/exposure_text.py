"""Exposure times in words, as a camera shows them."""

import numpy as np

from hdrlab.core.bracket import Bracket


def seconds(time: float) -> str:
    """Return an exposure time as a camera shows it: '1/60 s', '2 s'.

    Examples
    --------
    >>> [seconds(t) for t in (1 / 60, 0.3, 2, 2.5)]
    ['1/60 s', '0.3 s', '2 s', '2.5 s']
    """
    if time >= 1 or abs(1 / time - round(1 / time)) > 0.02 / time:
        return f"{time:.3g} s"
    return f"1/{round(1 / time)} s"


def exposures(bracket: Bracket) -> list[str]:
    """Return the exposure of each photo: seconds, or stops from the shortest if only ratios are known.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from hdrlab.core.bracket import bracket
    >>> taken = bracket(np.zeros((2, 1, 1), np.uint8), [0.1, 0.4])
    >>> exposures(taken), exposures(replace(taken, has_relative_times=True))
    (['1/10 s', '0.4 s'], ['+0.0 stops', '+2.0 stops'])
    """
    if not bracket.has_relative_times:
        return [seconds(time) for time in bracket.times]
    stops = np.log2(bracket.times / bracket.times.min())
    return [f"+{value:.1f} stops" for value in stops]
