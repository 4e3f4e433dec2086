"""More light after the fact, along a simulated camera response (Battiato et al. 2008, sec. 1.3.3).

Y      levels             (H, W), 0 to 255
q      light              stops, 0 anywhere
f      simulated response, f(q) = 255 / (1 + e^-Aq)^C: A and C shape its shoulder and its toe
delta  how much more light the photograph should have had, stops
p      share of the pixels at each level, (256,)
target where their mean belongs, level 128

Every level moves along f by delta stops, as it would have with a longer exposure. Black and white
stay where they are, which a factor or an added constant would not do; what was clipped stays
clipped.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.special import expit, logit

from hdrlab.core.arrays import F64, Array, ArrayLike

# A and C for which f lies within 4 levels of the curve of sRGB from level 20 to 200, by least
# squares.
A = 1.79
C = 0.192
# level
TARGET = 128.0
# stops: a photograph that lacks more shows nothing
DELTA_LIMIT = 8.0
# levels
TOLERANCE = 0.5
LEVELS = np.arange(256)


class State(NamedTuple):
    """One round: the light added so far, stops, and the mean level that it leads to."""

    delta: float
    mean: float


def f(q: ArrayLike, *, a: float = A, c: float = C) -> F64:
    """Return f(q) = 255 / (1 + e^-Aq)^C [Battiato08 eq. 1.9]; expit(x) = 1 / (1 + e^-x)."""
    return 255 * expit(a * np.asarray(q, np.float64)) ** c


def f_inv(Y: ArrayLike, *, a: float = A, c: float = C) -> F64:
    """Return q = -ln((255 / Y)^(1/C) - 1) / A: level 0 has no light at all, -inf, and level 255 all, inf."""
    return logit((np.asarray(Y, np.float64) / 255) ** (1 / c)) / a


def offset(average: float, target: float = TARGET, *, a: float = A, c: float = C) -> float:
    """Return delta = f^-1(target) - f^-1(average) [Battiato08 eq. 1.10], DELTA_LIMIT stops at most."""
    return float(
        np.clip(f_inv(target, a=a, c=c) - f_inv(average, a=a, c=c), -DELTA_LIMIT, DELTA_LIMIT)
    )


def curve(delta: float, *, a: float = A, c: float = C) -> F64:
    """Return Y' = f(f^-1(Y) + delta) of the 256 levels [Battiato08 eq. 1.11].

    Examples
    --------
    >>> curve(1.0)[[0, 64, 128, 255]].round().tolist()
    [0.0, 90.0, 176.0, 255.0]
    """
    return f(f_inv(LEVELS, a=a, c=c) + delta, a=a, c=c)


def table(delta: float, *, a: float = A, c: float = C) -> Array:
    """Return the curve rounded to levels: the look-up table (256,); of delta = 0 it is the identity."""
    return np.floor(curve(delta, a=a, c=c) + 0.5).astype(np.uint8)


def shares(Y: ArrayLike) -> F64:
    """Return p, the share of the pixels at each of the 256 levels."""
    return np.bincount(np.rint(Y).astype(np.intp).ravel(), minlength=256) / np.size(Y)


def settle_steps(p: F64, target: float = TARGET, *, a: float = A, c: float = C) -> Iterator[State]:
    """Yield the State before any light and after each round of eq. 1.10, until the mean is on target.

    One round, as the paper has it, moves the *average level* to the target. The mean of the moved
    levels is another thing, for f is curved: it is off by 10 levels and more where the regions hold
    light and shade. So the round is repeated with the mean that resulted, a dozen times at most.
    """
    delta = 0.0
    mean = float(p @ LEVELS)
    for _ in range(13):
        yield State(delta, mean)
        if abs(mean - target) < TOLERANCE or not 0 < mean < 255:
            return
        delta = float(np.clip(delta + offset(mean, target, a=a, c=c), -DELTA_LIMIT, DELTA_LIMIT))
        mean = float(p @ curve(delta, a=a, c=c))
