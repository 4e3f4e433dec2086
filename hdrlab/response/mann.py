"""The response as a power law, from a series of comparisons (Mann and Picard, IS&T 1995).

M       level                     alpha ... n - 1
alpha   level without light       of a photograph with the lens covered
gamma   exponent                  M = alpha + beta I^gamma: gamma 1 is a linear camera, 1 / 2.2 a television's
R       ratio of two exposures    dark over bright, < 1
T       bright to dark frame      (n,), the level in the dark frame of what has level M in the bright one
series  M(I), M(R I), M(R^2 I) .. (K,) levels, each R times the exposure of the one before

A pixel has level M(I) in the bright frame and M(R I) in the dark one. Look for another pixel of the bright
frame that has M(R I); in the dark one it has M(R^2 I), and so on down: a ladder of exposures, R apart,
whatever the scene. On logarithmic paper, ln(M - alpha) against the logarithm of exposure, a power law is a
straight line of slope gamma. Few cameras are so simple, and on others the line is a compromise.
"""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core.arrays import as_stack, as_times
from hdrlab.core.transfer import mid_step
from hdrlab.response.grossberg import histograms

Float = NDArray[np.float64]
LOW = 12.0  # of 256 levels: below, rounding and noise bend a logarithm
HIGH = 249.0  # above, a level is clipped
LEAST = 0.5  # levels: a lower rung is no rung, but the rounding of two frames of one exposure


def series(T: Float, start: float, *, low: float = LOW) -> Float:
    """Return the levels start, T(start), T(T(start)) ..., down to `low` or to where T knows no answer."""
    known = np.isfinite(T)
    levels, found = np.flatnonzero(known), [float(start)]
    while len(levels) and levels[0] <= found[-1] <= levels[-1]:
        below = float(np.interp(found[-1], levels, T[known]))
        if not low <= below <= found[-1] - LEAST:
            break
        found.append(below)
    return np.array(found)


def exponent(ladders: list[tuple[Float, float]], *, alpha: float = 0.0) -> float:
    """Return gamma, the slope that all ladders (series, R) share, ln(M - alpha) over k ln R, at best."""
    above = slope = 0.0
    for levels, R in ladders:
        x, y = np.arange(len(levels)) * np.log(R), np.log(levels - alpha)
        above += float((x - x.mean()) @ y)
        slope += float((x - x.mean()) @ x)
    if slope == 0:
        raise ValueError("expected levels seen well in two exposures; no series has a second member")
    return above / slope


def curve(gamma: float, *, alpha: float = 0.0, n: int = 256) -> Float:
    """Return g = ln(M - alpha) / gamma, g(n // 2) = 0; below half a level above alpha, the middle of that."""
    g = np.log(np.maximum(np.arange(n) - alpha, 0.25)) / gamma
    return g - g[n // 2]


def ladders(
    h: ArrayLike, times: ArrayLike, *, starts: int = 8, low: float = LOW
) -> Iterator[tuple[Float, float]]:
    """Yield (series, R) from histograms h (P, 256), for each two exposures next to each other.

    The paper goes down once; from other starts on the first step it goes down between those rungs.
    """
    h, t = np.asarray(h), np.asarray(times, np.float64)
    for a, b in pairwise(np.argsort(t, kind="stable")):
        T = mid_step(h[b], h[a])
        top = min(HIGH, float(np.max(np.flatnonzero(np.isfinite(T)), initial=0)))
        if t[a] == t[b] or top < low:
            continue
        first = series(T, top, low=low)
        for start in np.linspace(top, first[min(1, len(first) - 1)], starts, endpoint=False):
            yield series(T, start, low=low), float(t[a] / t[b])


def recover(
    images: ArrayLike,
    times: ArrayLike,
    *,
    alpha: float = 0.0,
    starts: int = 8,
    valid: ArrayLike | None = None,
) -> Float:
    """Return the response g of a camera that follows a power law, each channel by itself.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs of the same light, not necessarily aligned; 16 bits are read at 256 levels.
    times : (P,) float
        Exposure times in seconds, at least two different ones.
    alpha : float
        Level of 256 that a photograph has with the lens covered, 0 to 64.
    starts : int
        How many series to begin for each two exposures.
    valid : (P, H, W) bool, optional
        False where a photograph holds no picture.

    Returns
    -------
    (256,) or (256, 3) float64
        g, the ln exposure of each level; g[128] = 0.

    Raises
    ------
    ValueError
        For photographs whose histograms do not overlap between two exposures, and arrays that are no bracket.

    References
    ----------
    Mann and Picard, On being undigital with digital cameras: extending dynamic range by combining differently
    exposed pictures, IS&T 48th annual conference, 1995.

    Examples
    --------
    >>> light = np.linspace(0.02, 1, 10_000).reshape(100, 100)  # under a television's response
    >>> M = (light * np.array([0.25, 0.5, 1])[:, None, None]) ** (1 / 2.2)
    >>> g = recover(np.round(255 * M).astype(np.uint8), [1, 2, 4])
    >>> bool(abs(g[200] - 2.2 * np.log(200 / 128)) < 0.01)
    True
    """
    stack = as_stack(images)
    times = as_times(times, len(stack))
    if not 0 <= alpha <= 64 or starts < 1:
        raise ValueError(f"expected alpha from 0 to 64 and at least one start, got {alpha} and {starts}")
    low = LOW + alpha
    gammas = [
        exponent(list(ladders(h, times, starts=starts, low=low)), alpha=alpha)
        for h in histograms(stack, valid)
    ]
    return np.stack([curve(gamma, alpha=alpha) for gamma in gammas], axis=-1).reshape(256, *stack.shape[3:])
