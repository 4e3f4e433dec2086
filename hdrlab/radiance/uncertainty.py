"""How sure is each pixel: the mean by inverse variance, and what chance leaves of doubt in it.

Z      pixel levels       (P, H, W, C)
X      exposure           exp(g(Z)): 1 is that of level n / 2
D      step               dX / dZ, the exposures that are rounded to one level
N, R   electrons at X = 1, and read noise in electrons: `capture.photon_transfer` finds both
rho    what errs with the light itself, as a share of it: pixels that are unlike, a response that is not right
t      exposure times     (P,) seconds
E, s   radiance, and its standard deviation, (H, W[, C]) float32

Photons come by chance: of X N electrons the variance is X N. The amplifier adds R^2, and rounding
spreads evenly over a step. So a frame's answer X / t is as sure as its light allows, and the mean
in which each counts by the inverse of its variance has the least variance of all (Granados et al.,
CVPR 2010). The variance is that of the light which is there and not of the light which was counted:
a frame with too few photons, by chance, would count too much. So it begins with X, and then is
taken from E itself, in two rounds. What errs with the light does so in all frames alike, and no
mean takes it away: it is added in the end.
"""

from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F32, F64, ArrayLike, Mask
from hdrlab.errors import InputError
from hdrlab.radiance.merge import TOP, as_tables, bound

ROUNDS = 2
# a full well with this many deviations of read noise too few still measures nothing
FULL = 5


class Sure(NamedTuple):
    """The radiance map (H, W[, 3]) float32, and its standard deviation; infinite where no frame measures."""

    E: F32
    s: F32


def variance(X: F64, D: F64, N: ArrayLike, R: ArrayLike) -> F64:
    """Return V = X / N + (R / N)^2 + D^2 / 12: of photons, of the amplifier, of rounding.

    Examples
    --------
    >>> float(variance(np.array(1.0), np.array(0.0), 100, 0)) ** 0.5  # of 100 electrons, 10 by chance
    0.1
    """
    N = np.asarray(N, np.float64)
    R = np.asarray(R, np.float64)
    return X / N + (R / N) ** 2 + D**2 / 12


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
        for _ in range(1 + ROUNDS):
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
    """Return the radiance map by inverse variance, and its standard deviation.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Aligned photographs, in any order. Levels that clip measure nothing, each channel by itself,
        nor does level 0, where its step is wider than the noise.
    times : (P,) float
        Exposure times in seconds.
    g : (n,) or (n, 3) float
        Response, ln exposure of each level.
    N : float or (3,)
        Electrons of a pixel at the exposure X = 1, that of level n / 2.
    R : float or (3,)
        Read noise in electrons, standard deviation.
    rho : float or (3,)
        Of what errs with the light, the standard deviation as a share of it.

    Returns
    -------
    Sure
        E and s (H, W) or (H, W, 3) float32. Where no frame measures, E is what the bounds allow and
        s is infinite.

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
    stack, t, _, curves, top = as_tables(images, times, g, None, "mean", TOP)
    Z = stack.reshape(*stack.shape[:3], -1)
    c = np.arange(stack[0, 0, 0].size)
    for name, value, floor in (("N", N, 1e-12), ("R", R, 0), ("rho", rho, 0)):
        one = np.asarray(value, np.float64)
        if one.shape not in ((), c.shape) or not np.all((one >= floor) & (one < np.inf)):
            raise InputError(
                f"expected {name} of at least {floor:g}, one or one a channel, got {value}"
            )
    table = np.exp(curves)
    steps = np.gradient(np.exp(curves), axis=0)
    R = np.asarray(R, np.float64)
    E, s = np.empty((2, *Z.shape[1:]))
    for y, row in enumerate(Z.swapaxes(0, 1)):  # the processor's cache holds one
        X = table[row, c]
        D = steps[row, c]
        measured = (X < np.minimum(table[top], table[-1] - FULL * R / N)) & (
            (row > 0) | (D < R / N)
        )
        E[y], s[y] = inverse_variance_merge(X, D, measured, t, N, R)
        E[y] = np.where(measured.any(axis=0), E[y], bound(row, np.log(t), curves, top, row >= 0)[0])
    s = np.hypot(s, np.asarray(rho) * E)
    return Sure(*(one.reshape(stack.shape[1:]).astype(np.float32) for one in (E, s)))
