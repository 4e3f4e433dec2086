"""The space of camera responses as a prior (Grossberg and Nayar, CVPR 2003: [Grossberg03b]).

curves  (C, n)   many responses at the same n places: g over the pixel levels, or brightness over exposure
mean    (n,)     of the curves
H       (K, n)   principal components, orthonormal rows
sd      (K,)     how far the curves spread along each
c       (K,)     coefficients: curve = mean + c H  [Grossberg03b eq. 6]

Responses are alike. A handful of numbers distinguishes them, and a few samples of a curve, or a
poor bracket, are enough with the prior c ~ Normal(0, sd): the answer is the maximum a posteriori
(MAP) estimate.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from hdrlab.core import sampling, weights
from hdrlab.core.arrays import F64, ArrayLike, Indices, as_stack, as_table, as_times, describe
from hdrlab.errors import InputError
from hdrlab.response import families


class Space(NamedTuple):
    """mean (n,), components H (K, n), and the spread sd (K,) along each."""

    mean: F64
    H: F64
    sd: F64


def fit_space(curves: ArrayLike, count: int) -> Space:
    """Return the Space of the `count` directions along which the curves (C, n) spread most.

    With the SVD curves - mean = U S V^T, H is the first rows of V^T and sd = S / sqrt(C).

    Raises
    ------
    ValueError
        For curves that are not finite, or fewer than `count` + 1 of them.

    Examples
    --------
    >>> x = np.linspace(0, 1, 11)
    >>> space = fit_space([x, x**2, (x + x**2) / 2], 1)
    >>> bool(np.allclose(reconstruct(project(x**2, space), space), x**2))
    True
    """
    curves = np.asarray(curves, np.float64)
    if curves.ndim != 2 or not np.all(np.isfinite(curves)) or not 1 <= count < len(curves):
        raise InputError(
            f"expected more than {count} >= 1 finite curves (C, n), got {describe(curves)}"
        )
    mean = curves.mean(axis=0)
    _, S, V = np.linalg.svd(curves - mean, full_matrices=False)
    return Space(mean, V[:count], S[:count] / np.sqrt(len(curves)))


def truncate(space: Space, count: int) -> Space:
    """Return the Space of the first `count` components alone."""
    if not 1 <= count <= len(space.H):
        raise InputError(f"expected 1 to {len(space.H)} components, got {count}")
    return Space(space.mean, space.H[:count], space.sd[:count])


def project(curve: ArrayLike, space: Space) -> F64:
    """Return c = H (curve - mean), the nearest point of the space; curves (..., n) give (..., K)."""
    curve = np.asarray(curve, np.float64)
    if curve.shape[-1:] != space.mean.shape:
        raise InputError(
            f"expected a curve at the space's {len(space.mean)} places, got {describe(curve)}"
        )
    return (curve - space.mean) @ space.H.T


def reconstruct(c: ArrayLike, space: Space) -> F64:
    """Return mean + c H [Grossberg03b eq. 6]."""
    return space.mean + np.asarray(c, np.float64) @ space.H


def solve_map(A: F64, b: F64, sd: F64) -> F64:
    """Return c that minimises |A c - b|^2 + |c / sd|^2: the rows have unit noise, and c ~ Normal(0, sd)."""
    rows = np.vstack([A, np.diag(1 / np.maximum(sd, 1e-12))])
    return np.linalg.lstsq(rows, np.r_[b, np.zeros(len(sd))])[0]


def fit_samples(places: ArrayLike, values: ArrayLike, space: Space, *, noise: float = 0.002) -> F64:
    """Return the MAP estimate of a curve (n,) from a few of its samples.

    Parameters
    ----------
    places : (m,) float
        Where the samples are, 0 to 1: 0 is the first of the space's n places, 1 the last.
    values : (m,) float
        The curve there, in the unit of the space's curves.
    space : Space
        The prior.
    noise : float
        Standard deviation of the values.

    Raises
    ------
    ValueError
        For samples that do not fit together, or a noise that is not positive.

    Examples
    --------
    >>> x = np.linspace(0, 1, 256)
    >>> space = fit_space([x**gamma for gamma in np.arange(0.3, 1, 0.05)], 4)
    >>> curve = fit_samples([0.2, 0.6], [0.2**0.45, 0.6**0.45], space)
    >>> bool(np.abs(curve - x**0.45).max() < 0.03)
    True
    """
    places = np.asarray(places, np.float64)
    values = np.asarray(values, np.float64)
    if (
        places.ndim != 1
        or places.shape != values.shape
        or not np.all((places >= 0) & (places <= 1))
    ):
        raise InputError(
            f"expected places (m,) in 0 to 1 and values, got {describe(places)} and {describe(values)}"
        )
    if not np.all(np.isfinite(values)) or not noise > 0:
        raise InputError(
            f"expected finite values and a positive noise, got {describe(values)} and {noise}"
        )
    grid = np.linspace(0, 1, len(space.mean))
    A = np.column_stack([np.interp(places, grid, row) for row in space.H])
    b = values - np.interp(places, grid, space.mean)
    return reconstruct(solve_map(A / noise, b / noise, space.sd), space)


def default_space(count: int = 12, n: int = 256) -> Space:
    """Return the Space of g of the curves in `families`."""
    return fit_space(families.to_log(families.tabulate(n)), count)


def build_equations(Z: Indices, B: F64, w: F64, space: Space) -> tuple[F64, F64]:
    """Return A and b of sum_ij w^2 (g(Z_ij) - lE_i - B_j)^2 = |A c - b|^2, g = mean + c H [Debevec97 eq. 3].

    The best lE_i of each sample is a weighted mean over its frames. With the mean subtracted, the
    equations contain the K unknowns c alone.
    """
    W = w[Z] ** 2
    W = W / np.maximum(W.sum(axis=1, keepdims=True), 1e-300)

    def without_mean(x: F64) -> F64:
        return x - np.sum(W * x, axis=1, keepdims=True)

    B_differences = without_mean(B + 0 * Z)
    if not np.any(W * B_differences**2 > 1e-12):
        raise InputError("expected samples that are well exposed in two photos, got none")
    H = [w[Z] * without_mean(row[Z]) for row in space.H]
    A = np.stack(H, axis=-1).reshape(-1, len(H))
    b = w[Z] * B_differences - w[Z] * without_mean(space.mean[Z])
    return A, b.ravel()


def recover(
    images: ArrayLike,
    times: ArrayLike,
    *,
    basis: Space | None = None,
    noise: float = 0.02,
    samples: int = 1000,
    w: ArrayLike | None = None,
    choose: Callable[..., Indices] = sampling.by_rank,
    valid: ArrayLike | None = None,
) -> F64:
    """Return the MAP estimate of the response g in a space of responses, each channel by itself.

    Debevec's equations with a curve of K coefficients in place of 256 levels and a smoothness.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs; 16 bits are read at 256 levels.
    times : (P,) float
        Exposure times in seconds, at least two different ones.
    basis : Space, optional
        Of g over 256 levels, `fit_space(families.invert_curves(exposure, brightness), count)` of
        curves that were measured; those of `families` by default.
    noise : float
        Standard deviation of ln exposure at the level of greatest weight. More noise gives the
        prior more weight.
    samples : int
        How many pixels to choose.
    w : (256,) float, optional
        Weights; the hat, cut above 0.98 of the top level.
    choose : function
        `sampling.by_rank` (default), `sampling.by_grid`, or your own with the same signature.
    valid : (P, H, W) bool, optional
        False where a photograph holds no picture.

    Returns
    -------
    (256,) or (256, 3) float64
        g, the ln exposure of each level; g[128] = 0 in every channel.

    Raises
    ------
    ValueError
        For fewer than two photographs or two times, a basis that is not of 256 levels, or
        photographs that hold no level measured well in two exposures.

    References
    ----------
    Grossberg and Nayar, What is the space of camera response functions?, CVPR 2003; Debevec and
    Malik, 1997, eq. 3.

    Examples
    --------
    >>> ramp = np.linspace(1, 100, 10_000).reshape(100, 100)  # a linear camera
    >>> images = np.clip(np.round(ramp * np.array([1, 2, 4])[:, None, None]), 0, 255).astype(np.uint8)
    >>> g = recover(images, [0.01, 0.02, 0.04])
    >>> bool(abs(g[200] - np.log(200 / 128)) < 0.01)
    True
    """
    stack = as_stack(images)
    times = as_times(times, len(stack), distinct=2)
    space = default_space() if basis is None else basis
    if space.mean.shape != (256,) or not noise > 0:
        raise InputError(
            f"expected a basis of 256 levels and a noise > 0, got {len(space.mean)} and {noise}"
        )
    w = weights.cut(weights.hat()) if w is None else as_table(w, 256)
    Z = choose(stack, samples, valid=valid)
    coefficients = []
    for Z_channel in sampling.split_channels(Z):
        A, b = build_equations(Z_channel, np.log(times), w / w.max(), space)
        coefficients.append(solve_map(A / noise, b / noise, space.sd))
    g = reconstruct(np.stack(coefficients), space).T
    return weights.make_monotone(g - g[128]).reshape(256, *stack.shape[3:])
