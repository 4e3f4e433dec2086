"""Contradiction between the frames at each pixel, and the part that noise and edges explain.

Z   pixel levels         (P, H, W, C)
x   ln E                 (P, H, W, C), of each frame alone: see `frames`
w   weights              (n,), how far to trust a level
v   weighted variance    (H, W), sum w (x - mean x)^2 / sum w; of logarithms, so exposure and unit drop out
s2  noise                (H, W), sum w s2(Z) / sum w
r   range                (H, W), of x over 3 x 3 pixels of a frame, sum w r / sum w

At an edge that is displaced a little in each frame, v is large too. But a shift of up to a pixel
changes ln E of a frame by at most r, so that sqrt(v) is less than r / 2. The score is sqrt(v) over
the tolerance tau + 2 s + edge r.
"""

from typing import NamedTuple

import numpy as np
from scipy.ndimage import maximum_filter

from hdrlab.core.arrays import F32, F64, Array, ArrayLike, Mask, as_table
from hdrlab.errors import InputError
from hdrlab.radiance.deghosting.frames import Calibrated
from hdrlab.radiance.stuck import BAND_ROWS

# in ln E; a measurement may be this far below the lower bound of a clipped frame
BOUND_TOLERANCE = 0.7


class Deviation(NamedTuple):
    """v, s2 and r, (H, W) float32 each, means over the channels; 0 where no frame measures a pixel."""

    v: F32
    s2: F32
    r: F32


def weighted_variance(x: Array, w: Array) -> F64:
    """Return v = sum w (x - m)^2 / sum w, m = sum w x / sum w, of frames (P, H, W); 0 where no w is above 0.

    Examples
    --------
    >>> weighted_variance(np.array([[[0.0, 1]], [[0, 3]]]), np.ones((2, 1, 2)))
    array([[0., 1.]])
    """
    total = np.maximum(w.sum(axis=0), 1e-30)
    m = (w * x).sum(axis=0) / total
    return (w * (x - m) ** 2).sum(axis=0) / total


def measure_deviation(taken: Calibrated, w: ArrayLike) -> Deviation:
    """Return the weighted variance of each pixel, and the noise and the range that explain a part of it.

    A frame that clips one channel of a pixel is left out, as in the merge. Where a single frame
    measures a pixel, v is 0.

    Parameters
    ----------
    taken : Calibrated, from `frames.calibrate_frames`
    w : (n,), weights of the levels

    Raises
    ------
    ValueError
        For weights that are not (n,), negative, or all 0.

    Examples
    --------
    >>> from hdrlab.radiance.deghosting.frames import calibrate_frames
    >>> images = np.array([[[40, 40]], [[80, 160]]], np.uint8)  # the second pixel became twice as bright
    >>> linear = np.log(np.maximum(np.arange(256), 0.5) / 128)
    >>> taken = calibrate_frames(images, [1, 2], linear, np.ones((1, 2)))
    >>> np.sqrt(measure_deviation(taken, np.ones(256)).v).round(3)
    array([[0.   , 0.347]], dtype=float32)
    """
    pixels = taken.images
    tables = moment_tables(taken, w)
    x = taken.x.astype(np.float32)
    out = np.empty((3, *pixels.shape[1:3]), np.float32)
    for start in range(0, out.shape[1], BAND_ROWS):
        rows = slice(start, start + BAND_ROWS)
        sums = np.zeros((2, *pixels[0, rows].shape), np.complex64)
        spans = np.zeros(sums.shape[1:], np.float32)
        for j, frame in enumerate(pixels[:, rows]):
            channels = np.moveaxis(frame, -1, 0)
            in_use = np.all([Z < taken.top for Z in channels], axis=0)
            if taken.valid is not None:
                in_use &= taken.valid[j, rows]
            low, high = local_extremes(pixels[j], rows)
            for c, Z in enumerate(channels):
                first = tables[0, j, c].take(Z) * in_use
                sums[0, ..., c] += first
                sums[1, ..., c] += tables[1, j, c].take(Z) * in_use
                span = x[j, c].take(high[..., c]) - x[j, c].take(low[..., c])
                spans[..., c] += first.real * span
        total = np.maximum(sums[0].real, 1e-9)
        mean = sums[0].imag / total
        square = sums[1].real / total
        s2 = sums[1].imag / total
        v = np.maximum(square - mean**2, 0)
        out[0, rows] = v.mean(axis=-1)
        out[1, rows] = s2.mean(axis=-1)
        out[2, rows] = (spans / total).mean(axis=-1)
    return Deviation(v=out[0], s2=out[1], r=out[2])


def find_clipped_elsewhere(taken: Calibrated, E: F32) -> Mask:
    """Return where the plain map E (H, W, C) is far below the lower bound of a clipped frame, (H, W).

    This happens where something dark stood in front of a bright place in the only frame that
    measures it; v is 0 there. The tolerance excludes edges that are displaced by a pixel, and the
    light around a lamp.
    """
    brightest = maximum_filter(E, (3, 3, 1))
    is_darker = np.zeros(E.shape[:2], bool)
    for j, Z in enumerate(taken.images):
        bound = np.exp(taken.x[j, :, taken.top] - BOUND_TOLERANCE).astype(np.float32)
        below_bound = ((Z >= taken.top) & (brightest < bound)).all(axis=-1)
        if taken.valid is not None:
            below_bound &= taken.valid[j]
        is_darker |= below_bound
    return is_darker


def moment_tables(taken: Calibrated, w: ArrayLike) -> Array:
    """Return the tables of w + i w x and of w x^2 + i w s2, (2, P, C, n), to look up by level."""
    n = taken.x.shape[-1]
    trust = as_table(w, n)
    if trust.ndim != 1 or not np.all(trust >= 0) or not trust.any():
        raise InputError("expected weights (n,) that are not negative and not all 0")
    z = np.arange(n)
    trust = np.where((z > 0) & (z < taken.top), trust / trust.max(), 0)
    x = taken.x - np.median(taken.x[..., n // 2])  # about 0, where float32 is finest
    return np.stack([trust + 1j * trust * x, trust * x**2 + 1j * trust * taken.s2]).astype(
        np.complex64
    )


def local_extremes(frame: Array, rows: slice) -> tuple[Array, Array]:
    """Return the lowest and the highest level in the 3 x 3 pixels around each of some rows."""
    last = len(frame) - 1
    above = max(rows.start - 1, 0)
    below = min(rows.stop, last) + 1
    slab = np.pad(
        frame[above:below], [(rows.start == 0, rows.stop > last), (1, 1), (0, 0)], mode="edge"
    )
    low = slab
    high = slab
    for axis in (0, 1):
        low = _reduce_triples(np.minimum, low, axis)
        high = _reduce_triples(np.maximum, high, axis)
    return low, high


def _reduce_triples(ufunc: np.ufunc, values: Array, axis: int) -> Array:
    """Return the minimum or maximum of each three neighbours along an axis."""
    v = np.moveaxis(values, axis, 0)
    return np.moveaxis(ufunc(ufunc(v[:-2], v[1:-1]), v[2:]), 0, axis)


def score_contradiction(found: Deviation, *, tau: float, edge: float) -> F32:
    """Return sqrt(v) / (tau + 2 s + edge r): above 1, noise and edges do not explain the contradiction."""
    v, s2, r = found
    tolerated = np.float32(tau) + 2 * np.sqrt(s2) + np.float32(edge) * r
    return (np.sqrt(v) / tolerated).astype(np.float32)
