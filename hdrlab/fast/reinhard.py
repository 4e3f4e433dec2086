"""Photographic tone reproduction, fast: statistics of some pixels, neighbourhoods a band of rows at a time.

Letters as in `tonemap.reinhard`. All is float32, and a pixel beyond all measure is white like any
other.
"""

from functools import partial
from typing import Any

import numpy as np

from hdrlab.core import extremes, steps
from hdrlab.core.arrays import F32, as_luminance
from hdrlab.fast import _bands, blur, with_parts
from hdrlab.tonemap import reinhard

# scaled luminance
LIMIT = np.float32(1e15)
TINY = float(np.finfo(np.float32).tiny)
# rows at a time, which stay in the processor's cache
BAND = 64
KERNELS = tuple(blur._taps(s / 4) for s in reinhard.WIDTHS)
REACH = len(KERNELS[-1]) // 2


def log_average(L: F32, *, delta: float = 1e-6) -> float:
    """Return exp(mean(log(delta + L))), delta in medians of a quarter of a million pixels."""
    floor = max(delta * (extremes.positive_median(L) or 1.0), TINY)
    rows = _bands.banded(lambda L: np.log(L + np.float32(floor)).mean(axis=1, keepdims=True), L)
    return float(np.exp(rows.mean(dtype=np.float64)))


def scale_to_key(L: F32, *, key: float = 0.18) -> F32:
    """Return Lm = a L / Lav, at most LIMIT."""
    with np.errstate(over="ignore"):
        unit = np.float32(max(log_average(L) / key, TINY))
        return _bands.banded(lambda L: np.minimum(L / unit, LIMIT), L)


def white_point(Lm: F32) -> float:
    """Return the brightest Lm but for 0.01 % of the pixels, and at least 1."""
    return max(1.0, extremes.robust_maximum(Lm))


def display(Lm: F32, adaptation: F32, white: float = np.inf) -> F32:
    """Return the lesson's Ld, a band of rows at a time."""
    return _bands.banded(partial(reinhard.display, white=white), Lm, adaptation)


def local_adaptation(
    Lm: F32, *, key: float = 0.18, phi: float = 8.0, threshold: float = 0.05
) -> F32:
    """Return V1 of each pixel at its own width."""
    padded, V1 = blur._pad(Lm, REACH), np.empty_like(Lm)
    for top in range(0, len(Lm), BAND):
        rows, near = V1[top : top + BAND], padded[top : top + BAND + 2 * REACH]
        blurred = (blur._inside(near, k, REACH) for k in KERNELS)
        found = steps.last(
            reinhard.scale_steps(blurred, key=key, phi=phi, threshold=threshold)
        ).adaptation
        rows[:] = found[: len(rows), : rows.shape[1]]
    return V1


automatic_key = with_parts(__name__, reinhard.automatic_key, log_average=log_average)
_parts: dict[str, Any] = {
    "as_light": as_luminance,
    "automatic_key": automatic_key,
    "display": display,
}
_parts |= {
    "scale_to_key": scale_to_key,
    "white_point": white_point,
    "local_adaptation": local_adaptation,
}
tonemap = with_parts(__name__, reinhard.tonemap, **_parts)
