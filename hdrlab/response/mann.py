"""The response as a power law, from a series of comparisons (Mann and Picard, IS&T 1995).

M       level                     alpha ... n - 1
alpha   level without light       of a photograph with the lens covered
gamma   exponent                  M = alpha + beta I^gamma: gamma 1 is a linear camera, 1 / 2.2 a television's
R       exposure ratio            dark over bright, < 1
T       bright to dark frame      (n,), the level in the dark frame of what has level M in the bright one
series  M(I), M(R I), M(R^2 I) .. (K,) levels, each R times the exposure of the one before

A pixel has level M(I) in the bright frame and M(R I) in the dark one. Look for another pixel of the
bright frame that has level M(R I). In the dark frame it has M(R^2 I), and so on down: a ladder of
exposures, each R times the one above, whatever the scene. The paper compares pixels. Here
histograms give the transfer T, so the frames need not be aligned. On logarithmic paper, ln(M -
alpha) against the logarithm of exposure, a power law is a straight line of slope gamma. Few cameras
are so simple; for others the line is a compromise.
"""

from itertools import pairwise

import numpy as np

from hdrlab.core.arrays import F64, Array, ArrayLike, as_stack, as_times, to_256
from hdrlab.core.transfer import brightness_transfer, histograms
from hdrlab.errors import InputError

# Below this level rounding and noise bend a logarithm.
MIN_LEVEL = 12.0
# Above this level a pixel counts as clipped.
MAX_LEVEL = 249.0
# Two frames of equal exposure differ by rounding alone: a step of less than this is none.
MIN_LEVEL_STEP = 0.5
# alpha of a real camera is a few levels; a larger one leaves no range to fit.
MAX_ALPHA = 64


def descend(T: F64, start: float, *, low: float = MIN_LEVEL) -> F64:
    """Return the series start, T(start), T(T(start)) ..., down to `low` or to where T is unknown."""
    known = np.flatnonzero(np.isfinite(T))
    series = [float(start)]
    while len(known) and known[0] <= series[-1] <= known[-1]:
        below = float(np.interp(series[-1], known, T[known]))
        if not low <= below <= series[-1] - MIN_LEVEL_STEP:
            break
        series.append(below)
    return np.array(series)


def build_ladders(
    h: Array, times: F64, *, starts: int = 8, low: float = MIN_LEVEL
) -> list[tuple[F64, float]]:
    """Return (series, R) of each two neighbors in exposure, from histograms h (P, 256).

    The paper descends once, from the top. Further descents start between the first two levels of
    that series, so that their levels lie between its levels.
    """
    ladders = []
    for a, b in pairwise(np.argsort(times, kind="stable")):
        T = brightness_transfer(h[b], h[a])
        top = min(MAX_LEVEL, float(np.max(np.flatnonzero(np.isfinite(T)), initial=0)))
        if times[a] == times[b] or top < low:
            continue
        R = float(times[a] / times[b])
        first_series = descend(T, top, low=low)
        second = first_series[1] if len(first_series) > 1 else top
        tops = np.linspace(top, second, starts, endpoint=False)
        ladders += [(descend(T, start, low=low), R) for start in tops]
    return ladders


def fit_exponent(ladders: list[tuple[F64, float]], *, alpha: float = 0.0) -> float:
    """Return gamma, the slope that all ladders (series, R) share: ln(M - alpha) over k ln R."""
    xy = 0.0
    xx = 0.0
    for series, R in ladders:
        x = np.arange(len(series)) * np.log(R)
        y = np.log(series - alpha)
        xy += float((x - x.mean()) @ y)
        xx += float((x - x.mean()) @ x)
    if xx == 0:
        raise InputError("expected pixel values that are well exposed in two photos, got none")
    return xy / xx


def power_law(gamma: float, *, alpha: float = 0.0, n: int = 256) -> F64:
    """Return g = ln(M - alpha) / gamma with g(n // 2) = 0.

    Levels less than half a level above alpha count as a quarter: the middle of that half.
    """
    g = np.log(np.maximum(np.arange(n) - alpha, 0.25)) / gamma
    return g - g[n // 2]


def recover(
    images: ArrayLike,
    times: ArrayLike,
    *,
    alpha: float = 0.0,
    starts: int = 8,
    valid: ArrayLike | None = None,
) -> F64:
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
        For photographs whose histograms do not overlap between two exposures, arrays that are no
        bracket, and an alpha or a number of starts out of range.

    References
    ----------
    Mann and Picard, On being undigital with digital cameras: extending dynamic range by combining
    differently exposed pictures, IS&T 48th annual conference, 1995.

    Examples
    --------
    >>> light = np.linspace(0.02, 1, 10_000).reshape(100, 100)  # under a television's response
    >>> M = (light * np.array([0.25, 0.5, 1])[:, None, None]) ** (1 / 2.2)
    >>> g = recover(np.round(255 * M).astype(np.uint8), [1, 2, 4])
    >>> bool(abs(g[200] - 2.2 * np.log(200 / 128)) < 0.01)
    True
    """
    stack = as_stack(images)
    times = as_times(times, len(stack), distinct=2)
    if not 0 <= alpha <= MAX_ALPHA:
        raise InputError(f"expected alpha from 0 to {MAX_ALPHA}, got {alpha}")
    if starts < 1:
        raise InputError(f"expected at least one start, got {starts}")
    curves = []
    for h in histograms(to_256(stack), valid):
        ladders = build_ladders(h, times, starts=starts, low=MIN_LEVEL + alpha)
        curves.append(power_law(fit_exponent(ladders, alpha=alpha), alpha=alpha))
    return np.stack(curves, axis=-1).reshape(256, *stack.shape[3:])
