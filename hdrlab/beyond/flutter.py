"""Coded exposure: a fluttering shutter keeps a moving object sharp (Raskar et al., SIGGRAPH 2006).

x      object at rest           (n[, ...]): light along the direction of motion, any linear unit
h      shutter                  (m,) of 0 and 1, closed and open; the object moves a pixel per chop
y      exposure of the sensor   (n + m - 1[, ...]): y = h * x / m, the light of the open chops
A      the same as a matrix     (n + m - 1, n), each column h / m, a row lower than the one before
H      transfer function        |H(w)| = |sum of h_k e^(-i w k)| / m, of each spatial frequency
sigma  noise of the sensor, in the unit of y

An open shutter is a box filter, whose transfer function has zeros: these frequencies are lost, and
no computation restores them. A pseudo-random code of open and shut has no zeros. It lets half of the
light in.
"""

import numpy as np
from scipy.linalg import solve

from hdrlab.core.arrays import F64, ArrayLike, describe
from hdrlab.errors import InputError

# 52 chops
RASKAR_CODE = np.array(
    [int(chop) for chop in "1010000111000001010000110011110111010111001001100111"]
)
FREQUENCY_COUNT = 4096


def as_code(h: ArrayLike) -> F64:
    """Return a shutter's chops (m,) as 0.0 and 1.0, at least one of them open."""
    code = np.asarray(h, np.float64)
    if code.ndim != 1 or not np.all((code == 0) | (code == 1)) or not code.any():
        raise InputError(f"expected a code of 0 and 1 with at least one 1, got {describe(code)}")
    return code


def box(m: int) -> F64:
    """Return the shutter of an ordinary camera: open for all of its m chops."""
    return np.ones(m)


def transfer(h: ArrayLike, count: int = FREQUENCY_COUNT) -> F64:
    """Return |H(w)| at `count` frequencies from 0 to pi (half a cycle per pixel)."""
    code = as_code(h)
    return np.asarray(np.abs(np.fft.rfft(code / len(code), 2 * (count - 1))), np.float64)


def amplification(h: ArrayLike) -> float:
    """Return the RMS of 1 / |H|, by which deblurring amplifies noise; inf if H has a zero."""
    H = transfer(h)
    if H.min() <= 1e-12:
        return np.inf
    return float(np.sqrt(np.mean(1 / H**2)))


def equivalent_pictures(h: ArrayLike) -> float:
    """Return how many pictures of one chop, averaged, are as clean as one picture of this code.

    The average of n of them has a noise of amplification(one) / sqrt(n), so n is the quotient
    squared.
    """
    single_chop = np.zeros(len(as_code(h)))
    single_chop[0] = 1
    return (amplification(single_chop) / amplification(h)) ** 2


def smear(x: ArrayLike, h: ArrayLike) -> F64:
    """Return y = h * x / m along the first axis: each open chop adds the object at its position."""
    x = np.asarray(x, np.float64)
    code = as_code(h)
    y = np.zeros((len(x) + len(code) - 1, *x.shape[1:]))
    for k in np.flatnonzero(code):
        y[k : k + len(x)] += x / len(code)
    return y


def matrix(h: ArrayLike, n: int) -> F64:
    """Return A (n + m - 1, n), for which smear(x, h) = A x."""
    return smear(np.eye(n), h)


def sharpen(y: ArrayLike, h: ArrayLike) -> F64:
    """Deblur a photograph of a moving object by least squares: A' A x = A' y.

    Parameters
    ----------
    y : (n + m - 1[, ...]), a photograph in linear light, minus the background, of an object that
        moved m pixels down the first axis
    h : (m,) the shutter's chops, 0 and 1

    Returns
    -------
    x : (n[, ...]) float64

    Raises
    ------
    ValueError
        For a photograph no longer than the code, or one that is not finite.

    References
    ----------
    Raskar, Agrawal and Tumblin, Coded exposure photography: motion deblurring using fluttered
    shutter, SIGGRAPH 2006.

    Examples
    --------
    >>> x = np.array([0.0, 1.0, 4.0, 2.0])
    >>> sharpen(smear(x, [1, 0, 1, 1]), [1, 0, 1, 1]).round(6) + 0.0
    array([0., 1., 4., 2.])
    """
    y = np.asarray(y, np.float64)
    code = as_code(h)
    n = len(y) - len(code) + 1
    if y.ndim < 1 or n < 1 or not np.all(np.isfinite(y)):
        raise InputError(
            f"expected a finite photograph of at least {len(code)} rows, got {describe(y)}"
        )
    A = matrix(code, n)
    x: F64 = solve(A.T @ A, A.T @ y.reshape(len(y), -1), assume_a="pos")
    return x.reshape(n, *y.shape[1:])


def expose(
    x: ArrayLike,
    h: ArrayLike,
    *,
    gain: float = 1.0,
    sigma: float = 0.0,
    bits: int = 8,
    rng: int | np.random.Generator = 0,
) -> F64:
    """Return a photograph of the moving object, 1 = full: smeared, noisy, clipped and quantized."""
    X: F64 = gain * smear(x, h)
    X = X + np.random.default_rng(rng).normal(0, sigma, X.shape)
    top = 2**bits - 1
    return np.round(np.clip(X, 0, 1) * top) / top


def combine(photographs: ArrayLike, gains: ArrayLike) -> F64:
    """Merge photographs with different gains: each pixel from those in which it is not full.

    The weight is gain^2, for noise of the sensor alone. A pixel that is full in all photographs
    gets the value of the smallest gain.
    """
    X = np.asarray(photographs, np.float64)
    g = np.asarray(gains, np.float64)
    if X.ndim < 2 or g.shape != X.shape[:1] or not np.all(g > 0):
        raise InputError(
            f"expected photographs (P, n, ...) and P positive gains, got {describe(X)} and {g}"
        )
    g = g.reshape(-1, *[1] * (X.ndim - 1))
    w = np.where((X < 0.999) | (g == g.min()), g**2, 0)
    return (w * X / g).sum(axis=0) / w.sum(axis=0)
