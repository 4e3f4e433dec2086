"""Tables over the pixel levels: weights, and what keeps a response smooth and monotone.

z  pixel level, 0 ... n - 1
w  weight (n,), how far to trust it; 0 at both ends, where a value is only a bound
g  response (n, ...), ln exposure of each level

Which pixels are clipped is another question (see `radiance.merge`): a weight says how much a pixel
counts, validity whether it counts at all.
"""

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike
from hdrlab.errors import InputError


def hat(n: int = 256) -> F64:
    """Return w(z) = z below the middle, n - 1 - z above it [Debevec97 eq. 4], scaled to 1 in the middle.

    Examples
    --------
    >>> hat()[[0, 127, 128, 255]].tolist()
    [0.0, 1.0, 1.0, 0.0]
    """
    z = np.arange(n)
    return np.minimum(z, n - 1 - z) / ((n - 2) // 2)


def gaussian(n: int = 256) -> F64:
    """Return w(z) = exp(-4 (z - m)^2 / m^2), m the middle, shifted to 0 at both ends [Robertson03 sec. 3]."""
    m = (n - 1) / 2
    bell = np.exp(-4 * ((np.arange(n) - m) / m) ** 2)
    return (bell - bell[0]) / (1 - bell[0])


def flat(n: int = 256) -> F64:
    """Return w(z) = 1, and 0 at both ends: all levels that are not clipped count the same."""
    w = np.ones(n)
    w[[0, -1]] = 0
    return w


def cut(w: ArrayLike, *, above: float = 0.98, below: float = 0.0) -> F64:
    """Return w with 0 above and below these fractions of the top level [Cerman06 sec. 4.2 cuts above 0.98].

    Noise turns clipped pixels into nearly clipped ones, so pixels just below the top level may be
    clipped, too.
    """
    if not 0 <= below < above <= 1:
        raise InputError(f"expected 0 <= below < above <= 1, got below={below} and above={above}")
    w = np.asarray(w, dtype=np.float64)
    z = np.linspace(0, 1, len(w))
    return np.where((z > above) | (z < below), 0.0, w)


def snr(g: ArrayLike, *, least: float = 0.01, span: int = 4) -> F64:
    """Return w = f / f', the signal-to-noise ratio for equal noise at all levels [Mitsunaga99 eq. 14].

    f = exp g is the exposure of each level; where g is (n, 3) it is the mean of the channels. Its
    slope f' is taken over `span` levels on either side, in units of the mean slope, and is at least
    `least`: where a curve is flat, the weight must stay finite. w is 1 in the middle, and 0 at both
    ends. It grows with the level, because the same noise matters less in brighter pixels. The paper
    has neither the span nor the bound, and no 0 at the ends.
    """
    g = np.asarray(g, dtype=np.float64)
    if g.ndim not in (1, 2) or len(g) < 3 or not np.all(np.isfinite(g)):
        raise InputError(f"expected a finite response (n,) or (n, 3), got shape {g.shape}")
    f = np.exp(g - g[-1]).reshape(len(g), -1).mean(axis=1)
    if not f[-1] > f[0]:
        raise InputError("expected a rising response, but it ends where it begins or below")
    z = np.arange(len(g))
    low = np.maximum(z - span, 0)
    high = np.minimum(z + span, len(g) - 1)
    slope = (f[high] - f[low]) / (high - low) * (len(g) - 1) / (f[-1] - f[0])
    w = f / np.maximum(slope, least)
    w[[0, -1]] = 0
    return w / w[len(g) // 2]


def second_differences(w: F64, smoothness: float) -> F64:
    """Return the matrix (n - 2, n) of lambda w(z) g''(z), which gsolve keeps small [Debevec97 eq. 3].

    Examples
    --------
    >>> second_differences(np.ones(4), 10) @ [0, 1, 2, 4]  # g'' is 0 on a line
    array([ 0., 10.])
    """
    return smoothness * w[1:-1, None] * np.diff(np.eye(len(w)), 2, axis=0)


def make_monotone(g: F64) -> F64:
    """Return g (n, ...) made monotone: each fall becomes flat, outward from the middle level.

    Examples
    --------
    >>> make_monotone(np.array([-1.0, -2.0, 0.0, 2.0, 1.0])).tolist()
    [-2.0, -2.0, 0.0, 2.0, 2.0]
    """
    m = len(g) // 2
    up = np.maximum.accumulate(g[m:], axis=0)
    down = np.minimum.accumulate(g[m::-1], axis=0)
    return np.concatenate([down[::-1], up[1:]])
