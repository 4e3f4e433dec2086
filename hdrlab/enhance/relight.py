"""Brighten a photograph along a simulated camera response (Battiato et al. 2008, sec. 1.3.3).

Y      levels             (H, W), 0 to 255
q      light              stops, 0 anywhere
f      simulated response, f(q) = 255 / (1 + e^-Aq)^C: A and C shape its shoulder and its toe
delta  light to add            stops
p      fraction of the pixels at each level, (256,)
target mean level after the correction, 128

Every level moves along f by delta stops, as if the exposure had been longer. Black and white stay
as they are, which they would not with a factor or an added constant. Clipped pixels stay clipped.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.special import expit, logit

from hdrlab.core.arrays import F64, Array, ArrayLike

# A and C fitted by least squares: f is within 4 levels of the sRGB curve from level 20 to 200
A = 1.79
C = 0.192
# mean level after the correction
TARGET = 128.0
# stops; a photograph that needs more shows nothing
DELTA_LIMIT = 8.0
_LEVEL_TOLERANCE = 0.5
_MAX_ROUNDS = 12
LEVELS = np.arange(256)


class State(NamedTuple):
    """The light added so far, in stops, and the resulting mean level."""

    delta: float
    mean: float


def f(q: ArrayLike, *, a: float = A, c: float = C) -> F64:
    """Return f(q) = 255 / (1 + e^-Aq)^C [Battiato08 eq. 1.9]; expit(x) = 1 / (1 + e^-x)."""
    return 255 * expit(a * np.asarray(q, np.float64)) ** c


def f_inv(Y: ArrayLike, *, a: float = A, c: float = C) -> F64:
    """Return q = -ln((255 / Y)^(1/C) - 1) / A, which is -inf for level 0 and inf for level 255."""
    return logit((np.asarray(Y, np.float64) / 255) ** (1 / c)) / a


def offset(average: float, target: float = TARGET, *, a: float = A, c: float = C) -> float:
    """Return delta = f^-1(target) - f^-1(average) [Battiato08 eq. 1.10], at most 8 stops either way."""
    delta = f_inv(target, a=a, c=c) - f_inv(average, a=a, c=c)
    return float(np.clip(delta, -DELTA_LIMIT, DELTA_LIMIT))


def curve(delta: float, *, a: float = A, c: float = C) -> F64:
    """Return Y' = f(f^-1(Y) + delta) of the 256 levels [Battiato08 eq. 1.11].

    Examples
    --------
    >>> curve(1.0)[[0, 64, 128, 255]].round().tolist()
    [0.0, 90.0, 176.0, 255.0]
    """
    return f(f_inv(LEVELS, a=a, c=c) + delta, a=a, c=c)


def table(delta: float, *, a: float = A, c: float = C) -> Array:
    """Return the curve rounded to levels, a look-up table (256,); for delta = 0 it is the identity."""
    return np.floor(curve(delta, a=a, c=c) + 0.5).astype(np.uint8)


def shares(Y: ArrayLike) -> F64:
    """Return p, the fraction of the pixels at each of the 256 levels."""
    return np.bincount(np.rint(Y).astype(np.intp).ravel(), minlength=256) / np.size(Y)


def settle_steps(p: F64, target: float = TARGET, *, a: float = A, c: float = C) -> Iterator[State]:
    """Yield the State without added light and after each round of eq. 1.10, until the mean is on target.

    One round, as in the paper, moves the *average level* to the target. But the mean of the moved
    levels is different, as f is curved: it may be off by more than 10 levels if the regions contain
    light and shade. So the round is repeated with the resulting mean, up to a dozen times.
    """
    delta = 0.0
    mean = float(p @ LEVELS)
    yield State(delta, mean)
    for _ in range(_MAX_ROUNDS):
        if abs(mean - target) < _LEVEL_TOLERANCE or not 0 < mean < 255:
            return
        delta = float(np.clip(delta + offset(mean, target, a=a, c=c), -DELTA_LIMIT, DELTA_LIMIT))
        mean = float(p @ curve(delta, a=a, c=c))
        yield State(delta, mean)
