"""Photographic tone reproduction, fast: statistics from a part of the pixels, and bands of rows.

Letters as in `tonemap.reinhard`. All arrays are float32. Scaled luminance is limited, as an extreme
pixel becomes white anyway.
"""

from functools import partial
from typing import Any

import numpy as np

from hdrlab.core import extremes, steps
from hdrlab.core.arrays import F32, as_luminance
from hdrlab.fast import _bands, blur, with_parts
from hdrlab.tonemap import reinhard

MAX_SCALED_LUMINANCE = np.float32(1e15)
SMALLEST_FLOAT32 = float(np.finfo(np.float32).tiny)
# as many rows as stay in the processor's cache
BAND_ROWS = 64
KERNELS = tuple(blur._taps(s / 4) for s in reinhard.WIDTHS)
LARGEST_RADIUS = len(KERNELS[-1]) // 2


def log_average(L: F32, *, delta: float = 1e-6) -> float:
    """Return exp(mean(log(delta + L))), delta in medians of a quarter of a million pixels."""
    floor = max(delta * (extremes.positive_median(L) or 1.0), SMALLEST_FLOAT32)

    def row_means(L: F32) -> F32:
        return np.log(L + np.float32(floor)).mean(axis=1, keepdims=True)

    return float(np.exp(_bands.banded(row_means, L).mean(dtype=np.float64)))


def scale_to_key(L: F32, *, key: float = 0.18) -> F32:
    """Return Lm = a L / Lav, limited to 1e15."""
    with np.errstate(over="ignore"):
        unit = np.float32(max(log_average(L) / key, SMALLEST_FLOAT32))
        if np.isinf(unit):  # the light itself is near the largest float32
            factor = np.float32(key / log_average(L))
            return _bands.banded(lambda L: np.minimum(L * factor, MAX_SCALED_LUMINANCE), L)
        return _bands.banded(lambda L: np.minimum(L / unit, MAX_SCALED_LUMINANCE), L)


def white_point(Lm: F32) -> float:
    """Return the Lm that 0.01 % of the pixels exceed, but at least 1."""
    return max(1.0, extremes.robust_maximum(Lm))


def display(Lm: F32, adaptation: F32, white: float = np.inf) -> F32:
    """Return the lesson's Ld, computed in bands of rows."""
    return _bands.banded(partial(reinhard.display, white=white), Lm, adaptation)


def local_adaptation(
    Lm: F32, *, key: float = 0.18, phi: float = 8.0, threshold: float = 0.05
) -> F32:
    """Return V1 of each pixel at its own width."""
    padded = blur._pad(Lm, LARGEST_RADIUS)
    V1 = np.empty_like(Lm)
    for top in range(0, len(Lm), BAND_ROWS):
        rows = V1[top : top + BAND_ROWS]
        slab = padded[top : top + BAND_ROWS + 2 * LARGEST_RADIUS]
        blurred = (blur._inside(slab, k, LARGEST_RADIUS) for k in KERNELS)
        scales = reinhard.scale_steps(blurred, key=key, phi=phi, threshold=threshold)
        adaptation = steps.last(scales).adaptation
        rows[:] = adaptation[: len(rows), : rows.shape[1]]
    return V1


automatic_key = with_parts(__name__, reinhard.automatic_key, log_average=log_average)
_parts: dict[str, Any] = {
    "as_light": as_luminance,
    "automatic_key": automatic_key,
    "display": display,
    "scale_to_key": scale_to_key,
    "white_point": white_point,
    "local_adaptation": local_adaptation,
}
tonemap = with_parts(__name__, reinhard.tonemap, **_parts)
