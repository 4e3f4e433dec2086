"""More light after the fact, along a simulated camera response (Battiato et al. 2008, sec. 1.3.3).

Y      levels             (H, W), 0 to 255
q      light              stops, 0 anywhere
f      simulated response, f(q) = 255 / (1 + e^-Aq)^C: A and C shape its shoulder and its toe
delta  how much more light the photograph should have had, stops
p      share of the pixels at each level, (256,)
target where their mean belongs, level 128

Every level moves along f by delta stops, as it would have with a longer exposure. Black and white stay where
they are, which a factor or an added constant would not do; what was clipped stays clipped.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Float = NDArray[np.float64]

# A and C for which f lies within 4 levels of the curve of sRGB from level 20 to 200, by least squares.
A, C = 1.79, 0.192
TARGET = 128.0
MOST = 8.0  # stops: a photograph that lacks more holds nothing
CLOSE = 0.5  # levels
LEVELS = np.arange(256)


class State(NamedTuple):
    """One round: the light added so far, stops, and the mean level that it leads to."""

    delta: float
    mean: float


def f(q: ArrayLike, *, a: float = A, c: float = C) -> Float:
    """Return f(q) = 255 / (1 + e^-Aq)^C [Battiato08 eq. 1.9]."""
    with np.errstate(over="ignore"):  # e^-Aq of no light is infinite, and f of it 0
        return 255 / (1 + np.exp(-a * np.asarray(q, np.float64))) ** c


def inverse(Y: ArrayLike, *, a: float = A, c: float = C) -> Float:
    """Return q = -ln((255 / Y)^(1/C) - 1) / A: level 0 has no light at all, -inf, and level 255 all, inf."""
    with np.errstate(divide="ignore"):
        return -np.log((255 / np.asarray(Y, np.float64)) ** (1 / c) - 1) / a


def offset(average: float, target: float = TARGET, *, a: float = A, c: float = C) -> float:
    """Return delta = f^-1(target) - f^-1(average) [Battiato08 eq. 1.10], at most MOST stops either way."""
    return float(np.clip(inverse(target, a=a, c=c) - inverse(average, a=a, c=c), -MOST, MOST))


def curve(delta: float, *, a: float = A, c: float = C) -> Float:
    """Return Y' = f(f^-1(Y) + delta) of the 256 levels [Battiato08 eq. 1.11].

    Examples
    --------
    >>> curve(1.0)[[0, 64, 128, 255]].round().tolist()
    [0.0, 90.0, 176.0, 255.0]
    """
    return f(inverse(LEVELS, a=a, c=c) + delta, a=a, c=c)


def table(delta: float, *, a: float = A, c: float = C) -> NDArray[np.uint8]:
    """Return the curve rounded to levels: the look-up table (256,); of delta = 0 it is the identity."""
    return np.floor(curve(delta, a=a, c=c) + 0.5).astype(np.uint8)


def shares(Y: ArrayLike) -> Float:
    """Return p, the share of the pixels at each of the 256 levels."""
    counts = np.bincount(np.rint(np.asarray(Y)).astype(np.intp).ravel(), minlength=256)
    return counts / counts.sum()


def settle_steps(
    p: Float, target: float = TARGET, *, a: float = A, c: float = C, most: int = 12
) -> Iterator[State]:
    """Yield the State before any light and after each round of eq. 1.10, until the mean is on target.

    One round, as the paper has it, moves the *average level* to the target. The mean of the moved levels is
    another thing, for f is curved: it is off by 10 levels and more where the regions hold light and shade.
    So the round is repeated with the mean that came out.
    """
    delta, mean = 0.0, float(p @ LEVELS)
    yield State(delta, mean)
    for _ in range(most):
        if abs(mean - target) < CLOSE or not 0 < mean < 255:
            return
        moved = float(np.clip(delta + offset(mean, target, a=a, c=c), -MOST, MOST))
        if moved == delta:
            return
        delta, mean = moved, float(p @ curve(moved, a=a, c=c))
        yield State(delta, mean)
