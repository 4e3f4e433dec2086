"""The guided filter (He, Sun and Tang, ECCV 2010; IEEE Transactions on PAMI 35(6), 2013).

I        guide                     (H, W), such as log luminance
p        what is filtered          (H, W); to smooth a picture but for its edges, the guide itself
r        radius of a window        pixels; the square has (2 r + 1)^2, fewer at the picture's edge
eps      what variance is an edge  in squares of the unit of I: windows that vary less become flat
a, b     line of each window       (H, W), p = a I + b as well as it goes; a = 1 keeps I, a = 0 is its mean
q        p, smoothed               (H, W)

All lines are computed from means, whose cost does not depend on r. The bilateral filter compares
pixel by pixel; here one line holds for a whole window. So next to an edge fine detail stays in q and
is not smoothed.
"""

from typing import NamedTuple

import numpy as np
from scipy.ndimage import uniform_filter

from hdrlab.core.arrays import F64, ArrayLike
from hdrlab.errors import InputError


class Lines(NamedTuple):
    """Slope a (H, W) and offset b (H, W) of the line of the window around each pixel."""

    a: F64
    b: F64


def window_mean(v: F64, radius: int) -> F64:
    """Return the mean of v (H, W) over the part of each pixel's window that lies in the picture."""
    size = 2 * radius + 1
    total = uniform_filter(v, size, mode="constant")
    count = uniform_filter(np.ones_like(v), size, mode="constant")
    return total / count


def lines(I: F64, p: F64, *, radius: int, epsilon: float) -> Lines:  # noqa: E741
    """Return a = cov(I, p) / (var(I) + eps) and b = mean(p) - a mean(I) of each window [He13 eq. 5, 6].

    It is the least squares of (a I + b - p)^2 + eps a^2, summed over the window [He13 eq. 4]. The
    means of the whole picture are subtracted first: the squares of large numbers that differ by
    little would cancel.
    """
    offset_I = I.mean()
    offset_p = p.mean()
    I = I - offset_I  # noqa: E741
    p = p - offset_p
    mean_I = window_mean(I, radius)
    mean_p = window_mean(p, radius)
    cov = window_mean(I * p, radius) - mean_I * mean_p
    var = window_mean(I * I, radius) - mean_I**2
    a = cov / (np.maximum(var, 0) + epsilon)
    return Lines(a, mean_p + offset_p - a * (mean_I + offset_I))


def guided(I: ArrayLike, p: ArrayLike | None = None, *, radius: int, epsilon: float) -> F64:  # noqa: E741
    """Return q = mean(a) I + mean(b), means over all windows that hold the pixel [He13 eq. 8].

    Without p, the guide itself is filtered. I and p must be finite and of one shape (H, W), with
    radius >= 1 and epsilon > 0: anything else is a ValueError.

    Examples
    --------
    >>> step = np.where(np.arange(40) < 20, 0, 3) * np.ones((30, 1))
    >>> bool(np.allclose(guided(step, radius=4, epsilon=0.01), step, atol=0.1))
    True
    """
    I = np.asarray(I, np.float64)  # noqa: E741
    p = I if p is None else np.asarray(p, np.float64)
    is_finite = np.isfinite(I).all() and np.isfinite(p).all()
    if I.ndim != 2 or p.shape != I.shape or not is_finite:
        raise InputError(
            f"expected a finite guide (H, W) and p of its shape, got {I.shape} and {p.shape}"
        )
    if not (radius >= 1 and 0 < epsilon < np.inf):
        raise InputError(f"expected radius >= 1 and epsilon > 0, got {radius=}, {epsilon=}")
    a, b = lines(I, p, radius=radius, epsilon=epsilon)
    return window_mean(a, radius) * I + window_mean(b, radius)
