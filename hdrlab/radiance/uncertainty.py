"""Uncertainty of each pixel: the inverse-variance weighted mean, and its standard deviation.

Z      pixel levels       (P, H, W, C)
X      exposure           exp(g(Z)): 1 is that of level n / 2
D      step               dX / dZ, the exposures that are rounded to one level
N, R   electrons at X = 1, and read noise in electrons: `capture.photon_transfer` finds both
rho    relative error that is proportional to the light: unequal pixels, a wrong response
t      exposure times     (P,) seconds
E, s   radiance, and its standard deviation, (H, W[, C]) float32

Photons arrive at random: X N electrons have the variance X N. The amplifier adds R^2, and rounding
errors are uniform over a step. The mean of the frames' X / t, weighted by the inverse of their
variances, has the smallest variance of all means (Granados et al., CVPR 2010). The variance must be
that of the true light, not that of the counted photons: otherwise a frame that happened to count
too few would weigh too much. So it is first computed from X, and then from E, in two iterations. An
error that is proportional to the light is the same in all frames, and no mean removes it: it is
added at the end.

Light near the clip level of a frame is measured only if chance made its level low. To ask the level
itself would keep the low draws and drop the high ones. So the merge asks the light E t of a first
mean, and a frame counts the less, the closer that light is to its clip level.

Conditions: R is the noise of one read, the same for all times. Black stands above level 0: where a
camera cuts negative counts to 0, E of a few electrons is too large (with R = 6 and one frame, by
about 80 % at 2 electrons and 25 % at 4), although E +- 1.96 s still holds it.
"""

from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F32, F64, ArrayLike, Mask
from hdrlab.errors import InputError
from hdrlab.radiance.merge import CLIPPING_LEVEL, as_tables, bound

# after the first mean, in which the variances come from X
REWEIGHTING_ROUNDS = 2
# standard deviations of read noise below a full well from which a pixel may have been full
FULL_WELL_MARGIN = 5
# ln 40 / 1.96, rounded up: of light that clips, one draw in 40 is lower than the interval reaches
CLIPPING_TAIL = 2.0
# standard deviations below the clip level: light at least this far below it never reaches it
UNCLIPPED_DISTANCE = 6.0
# standard deviations: light closer to the clip level, or beyond it, counts as this close
MIN_CLIPPING_DISTANCE = 0.02


class Sure(NamedTuple):
    """The radiance map (H, W[, 3]) float32, and its standard deviation, infinite where no frame measures."""

    E: F32
    s: F32


def variance(X: F64, D: F64, N: ArrayLike, R: ArrayLike) -> F64:
    """Return the variance V = X / N + (R / N)^2 + D^2 / 12 from photons, the amplifier and rounding.

    R is the noise of one read. A dark current is not in it: d electrons a second add d t to R^2,
    which matters for exposures of many seconds on a warm sensor.

    Examples
    --------
    >>> float(variance(np.array(1.0), np.array(0.0), 100, 0)) ** 0.5  # of 100 electrons, 10 by chance
    0.1
    """
    N = np.asarray(N, np.float64)
    R = np.asarray(R, np.float64)
    return X / N + (R / N) ** 2 + D**2 / 12


def clipping_deviation(light: F64, V: ArrayLike, full: ArrayLike) -> F64:
    """Return 2 sqrt(V) (1 / d - 1 / 6), the deviation that is added as draws beyond `full` are not seen.

    d is the distance of the light to the clip level, (full - light) / sqrt(V), at most 6. Of light
    above the clip level only low draws are seen. They lie below the level by an exponential
    distribution of mean V / (light - full). So a draw that lies d sqrt(V) below it can stem from
    light up to sqrt(V) ln 40 / d above it, with a chance of 1 in 40 (2.5 %).

    Parameters
    ----------
    light : (...) float
        Exposure, expected from all frames.
    V : (...) float
        Its `variance`.
    full : float or (C,)
        Exposure of the clip level.

    Returns
    -------
    (...) float64
        Standard deviation, in the unit of light. Light beyond `full` counts as just below it.

    Examples
    --------
    >>> clipping_deviation(np.array([0.4, 0.8]), 0.01, 1).round(3)  # 6 and 2 deviations below
    array([0.   , 0.067])
    """
    sigma = np.sqrt(np.asarray(V, np.float64))
    distance = np.asarray(full, np.float64) - light
    d = np.clip(distance / sigma, MIN_CLIPPING_DISTANCE, UNCLIPPED_DISTANCE)
    return CLIPPING_TAIL * sigma * (1 / d - 1 / UNCLIPPED_DISTANCE)


def inverse_variance_merge(
    X: F64, D: F64, measured: Mask, t: ArrayLike, N: ArrayLike, R: ArrayLike
) -> tuple[F64, F64]:
    """Return E = sum (x / V) / sum (1 / V), x = X / t, V = variance / t^2, and s = 1 / sqrt(sum 1 / V).

    The sums are over the frames that measure a pixel. The variance is first that of the light X,
    and then, in two rounds, that of the light E t.

    Parameters
    ----------
    X : (P, H, W) float
        Exposures, what each level stands for.
    D : (P, H, W) float
        Steps, the exposures that are rounded to one level.
    measured : (P, H, W) bool
        False where a level measures nothing, as it is clipped.
    t : (P,) float
        Exposure times in seconds, in any order.
    N : float
        Electrons of a pixel at the exposure 1.
    R : float
        Read noise in electrons, standard deviation.

    Returns
    -------
    (E, s) : (H, W) and (H, W) float64
        Radiance, and its standard deviation, which is infinite where no frame measures; E is
        unknown there.

    References
    ----------
    Granados and others, Optimal HDR reconstruction with linear digital cameras, CVPR 2010.

    Examples
    --------
    >>> X, D, measured = np.array([[0.09], [0.22]]), np.zeros((2, 1)), np.ones((2, 1), bool)
    >>> E, s = inverse_variance_merge(X, D, measured, [1, 2], 100, 0)  # 31 electrons in 3 seconds
    >>> round(float(E[0]), 3), round(float(s[0]), 3)
    (0.103, 0.019)
    """
    t = np.reshape(np.asarray(t, np.float64), (-1,) + (1,) * (X.ndim - 1))
    E = X / t
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(1 + REWEIGHTING_ROUNDS):
            V = np.where(measured, variance(E * t, D, N, R) / t**2, np.inf)
            E = np.sum(X / t / V, axis=0) / np.sum(1 / V, axis=0)
        return E, 1 / np.sqrt(np.sum(1 / V, axis=0))


def merge_with_deviation(
    images: ArrayLike,
    times: ArrayLike,
    g: ArrayLike,
    N: ArrayLike,
    R: ArrayLike = 0.0,
    rho: ArrayLike = 0.0,
) -> Sure:
    """Return the radiance map by inverse-variance weighting, and its standard deviation.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Aligned photographs, in any order. Levels that clip measure nothing, each channel by itself,
        nor does level 0, where its step is wider than the noise. Where the light is close to a
        frame's clip level, the frame counts less.
    times : (P,) float
        Exposure times in seconds.
    g : (n,) or (n, 3) float
        Response, ln exposure of each level.
    N : float or (3,)
        Electrons of a pixel at the exposure X = 1, that of level n / 2.
    R : float or (3,)
        Read noise in electrons, standard deviation.
    rho : float or (3,)
        Relative standard deviation of errors that are proportional to the light.

    Returns
    -------
    Sure
        E and s (H, W) or (H, W, 3) float32. Where no frame measures, E comes from the bounds and s
        is infinite.

    Raises
    ------
    ValueError
        For arrays that do not fit together, and for noise that cannot be.

    References
    ----------
    Granados and others, Optimal HDR reconstruction with linear digital cameras, CVPR 2010.

    Examples
    --------
    >>> images = np.array([[[40, 255]], [[80, 255]]], np.uint8)  # a linear camera, one and two seconds
    >>> g = np.log(np.maximum(np.arange(256), 0.5) / 128)
    >>> found = merge_with_deviation(images, [1, 2], g, N=10_000)
    >>> found.E[0].round(2), found.s[0].round(4)
    (array([0.31, 1.95], dtype=float32), array([0.0034,    inf], dtype=float32))
    """
    stack, t, _, curves, top = as_tables(images, times, g, None, "mean", CLIPPING_LEVEL)
    Z = stack.reshape(*stack.shape[:3], -1)
    c = np.arange(stack[0, 0, 0].size)
    _check_noise("N", N, c.size, minimum=1e-12)
    _check_noise("R", R, c.size, minimum=0)
    _check_noise("rho", rho, c.size, minimum=0)
    table = np.exp(curves)
    steps = np.gradient(np.exp(curves), axis=0)
    R = np.asarray(R, np.float64)
    full = np.minimum(table[top], table[-1] - FULL_WELL_MARGIN * R / N)
    E = np.empty(Z.shape[1:])
    s = np.empty(Z.shape[1:])
    # one row at a time, which stays in the processor's cache
    for y, row in enumerate(Z.swapaxes(0, 1)):
        X = table[row, c]
        D = steps[row, c]
        measured = (X < full) & ((row > 0) | (D < R / N))
        first, _ = inverse_variance_merge(X, D, measured, t, N, R)
        light = first * t.reshape(-1, 1, 1)
        V = variance(light, D, N, R)
        # a uniform error over D has the variance D^2 / 12
        D = np.sqrt(D**2 + 12 * clipping_deviation(light, V, full) ** 2)
        mean, s[y] = inverse_variance_merge(X, D, measured, t, N, R)
        bounds, _ = bound(row, np.log(t), curves, top, row >= 0)
        E[y] = np.where(measured.any(axis=0), mean, bounds)
    s = np.hypot(s, np.asarray(rho) * E)
    shape = stack.shape[1:]
    return Sure(E.reshape(shape).astype(np.float32), s.reshape(shape).astype(np.float32))


def _check_noise(name: str, value: ArrayLike, channels: int, *, minimum: float) -> None:
    """Raise a ValueError unless a parameter of the noise is finite and at least `minimum`."""
    numbers = np.asarray(value, np.float64)
    if numbers.shape not in ((), (channels,)) or not np.all(
        (numbers >= minimum) & (numbers < np.inf)
    ):
        raise InputError(
            f"expected {name} of at least {minimum:g}, one number or one a channel, got {value!r}"
        )
