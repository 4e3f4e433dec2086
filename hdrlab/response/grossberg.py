"""The response from histograms alone (Grossberg and Nayar, PAMI 2003; Cerman and Hlavac 2006, sec. 4).

h   histogram                     (P, n) of each frame
J   comparagram                   (n, n), pixels with level m in frame A and z in frame B: frames aligned
T   brightness transfer function  (n,), the level in B of what has level m in A: see `core.transfer`
R   exposure ratio                t_A / t_B < 1
f   response                      light -> level
g   ln f^-1                       (n,), ln exposure of each level

All that two frames indicate about the response is T, for f^-1(m) = R f^-1(T(m)): the ridge of their
comparagram. And T is found without comparing pixels, since it takes ranks to ranks; so the frames
need not be aligned, and noise averages out. Two models take these equations: a table g, as Debevec
and Malik's, and a polynomial f^-1, Mitsunaga and Nayar's. From noisy pixels a polynomial of high
order fails; from histograms, without the levels above the cut, it does not.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from hdrlab.core import transfer, weights
from hdrlab.core.arrays import F64, Array, ArrayLike, Indices, as_stack, as_times, to_256
from hdrlab.errors import InputError
from hdrlab.response.mitsunaga import curve, terms


class Equations(NamedTuple):
    """f^-1(m) = R f^-1(T), each with a weight; m (K,) levels, T (K,) between levels, R and weight (K,)."""

    m: Indices
    T: F64
    R: F64
    weight: F64


def comparagram(A: ArrayLike, B: ArrayLike) -> Array:
    """Return J (256, 256), how many pixels have level m in A and z in B [Mann02]; frames (H, W), aligned."""
    a, b = to_256(as_stack([A, B])).reshape(2, -1).astype(np.intp)
    return np.bincount(a * 256 + b, minlength=65536).reshape(256, 256)


def build_equations(h: Array, times: F64, w: F64) -> Equations:
    """Return f^-1(m) = R f^-1(T(m)) of each two neighbours in exposure, from histograms h (P, n).

    An equation weighs as much as the lighter of its two levels, and as many pixels as lie at level
    m.
    """
    rows = []
    for a, b in pairwise(np.argsort(times, kind="stable")):
        T = transfer.brightness_transfer(h[a], h[b])
        m = np.flatnonzero(np.isfinite(T) & (h[a] > 0) & (times[a] < times[b]))
        weight = np.minimum(w[m], np.interp(T[m], np.arange(len(w)), w)) * np.sqrt(
            h[a][m] / h[a].sum()
        )
        rows.append((m, T[m], np.full(len(m), times[a] / times[b]), weight))
    return Equations(*(np.concatenate(column) for column in zip(*rows, strict=True)))


def build_pixel_equations(Z: Array, times: F64, w: F64) -> Equations:
    """Return the same from samples Z (N, P) of aligned frames, as both methods have it at first."""
    a, b = np.transpose([ab for ab in pairwise(np.argsort(times)) if times[ab[0]] < times[ab[1]]])
    m, T = Z[:, a].ravel(), Z[:, b].ravel()
    weight = np.minimum(w[m], w[T]) / np.sqrt(len(Z))
    return Equations(m, T.astype(np.float64), np.tile(times[a] / times[b], len(Z)), weight)


def interpolate_levels(T: F64, n: int = 256) -> F64:
    """Return A (K, n), A @ g = g(T) for levels T between whole ones."""
    return np.maximum(1 - np.abs(T[:, None] - np.arange(n)), 0)


def solve_table(found: Equations, w: F64, *, smoothness: float = 2.0) -> F64:
    """Return g (n,), the least of sum weight^2 (g(T) - g(m) + ln R)^2 + sum (lambda w(z) (g - ln z)''(z))^2.

    g(n // 2) = 0. The curvature is that away from a linear camera, for a logarithm has one of its
    own. Levels that no row constrains take the value of the nearest one that is.
    """
    if not np.any(found.weight > 0) or not 0 < smoothness < np.inf:
        raise InputError(
            f"expected levels measured well in two exposures, smoothness > 0, got {smoothness}"
        )
    z = np.arange(len(w))
    data = found.weight[:, None] * (interpolate_levels(found.T, len(w)) - np.eye(len(w))[found.m])
    penalty = weights.second_differences(w, smoothness)
    A = np.vstack([data, penalty, z == len(w) // 2])
    b = np.concatenate(
        [-found.weight * np.log(found.R), penalty @ np.log(np.maximum(z, 0.25)), [0]]
    )
    g, constrained = np.linalg.lstsq(A, b)[0], A.any(axis=0)
    g = np.interp(z, z[constrained], g[constrained])
    return g - g[len(w) // 2]


def solve_polynomial(found: Equations, *, order: int = 10, n: int = 256) -> F64:
    """Return c (N - 1,), the least of sum weight^2 (f^-1(m) - R f^-1(T))^2 [Grossberg03].

    f^-1(M) = M + sum_k c_k b_k(M) in the basis of `mitsunaga`: f^-1(0) = 0 and f^-1(1) = 1.
    """
    if not np.any(found.weight > 0) or not 1 <= order <= 20:
        raise InputError(
            f"expected an order to 20 and levels measured well in two exposures, got {order}"
        )
    M, MT = found.m / (n - 1), found.T / (n - 1)
    D = found.weight[:, None] * (terms(M, order) - found.R[:, None] * terms(MT, order))
    return np.asarray(np.linalg.lstsq(D[:, 1:], -D[:, 0])[0])


def recover(
    images: ArrayLike, times: ArrayLike, *, smoothness: float = 2.0, valid: ArrayLike | None = None
) -> F64:
    """Return the response g as a table, recovered from the frames' histograms, each channel by itself.

    The weights are the Gaussian without the levels above 0.98 of the top one, where noise hides
    clipped pixels, and those below 0.02; for others call `build_equations` and `solve_table`.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs of the same light, not necessarily aligned; 16 bits are read at 256 levels.
    times : (P,) float
        Exposure times in seconds, at least two different ones.
    smoothness : float
        lambda.
    valid : (P, H, W) bool, optional
        False where a photograph holds no picture.

    Returns
    -------
    (256,) or (256, 3) float64
        g, the ln exposure of each level, never falling; g[128] = 0.

    Raises
    ------
    ValueError
        For photographs whose histograms do not overlap between two exposures, and arrays that are
        no bracket.

    References
    ----------
    Grossberg and Nayar, Determining the camera response from images: what is knowable?, PAMI
    25(11), 2003. Cerman and Hlavac, Exposure time estimation for high dynamic range imaging with
    hand held camera, 2006.

    Examples
    --------
    >>> ramp = np.linspace(1, 100, 10_000).reshape(100, 100)  # a linear camera
    >>> images = np.clip(np.round(ramp * np.array([1, 2, 4])[:, None, None]), 0, 255).astype(np.uint8)
    >>> images[1] = images[1, ::-1, ::-1]  # it was held upside down
    >>> g = recover(images, [0.01, 0.02, 0.04])
    >>> bool(abs(g[200] - np.log(200 / 128)) < 0.01)
    True
    """
    stack = as_stack(images)
    times, w = as_times(times, len(stack), distinct=2), weights.cut(weights.gaussian(), below=0.02)
    channels = [build_equations(h, times, w) for h in transfer.histograms(to_256(stack), valid)]
    g = np.stack([solve_table(found, w, smoothness=smoothness) for found in channels], axis=-1)
    return weights.make_monotone(g).reshape(256, *stack.shape[3:])


def recover_polynomial(
    images: ArrayLike, times: ArrayLike, *, order: int = 10, valid: ArrayLike | None = None
) -> F64:
    """Return the response g as the logarithm of a polynomial of an order 1 to 20; see `recover`.

    The weights are the hat, for a polynomial needs the ends, without the levels above 0.98 of the
    top one.

    Raises
    ------
    ValueError
        As `recover`.
    """
    stack = as_stack(images)
    times, w = as_times(times, len(stack), distinct=2), weights.cut(weights.hat())
    channels = [build_equations(h, times, w) for h in transfer.histograms(to_256(stack), valid)]
    g = np.stack([curve(solve_polynomial(found, order=order)) for found in channels], axis=-1)
    return g.reshape(256, *stack.shape[3:])
