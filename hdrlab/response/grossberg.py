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
order fails; from histograms, without the levels above the cut, it does not. (In Cerman and Hlavac's
experiment it failed from histograms, too; the paper does not say why.) Here T takes the middle of a
level's ranks to the middle of another's, and the darkest levels have little weight.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from hdrlab.core import transfer, weights
from hdrlab.core.arrays import F64, Array, ArrayLike, Indices, as_stack, as_times, to_256
from hdrlab.errors import InputError
from hdrlab.response.mitsunaga import curve, terms


@dataclass(frozen=True, kw_only=True)
class Equations:
    """K weighted equations f^-1(m) = R f^-1(T) between the levels of two frames.

    Attributes
    ----------
    m : (K,) levels in the darker frame
    T : (K,) levels in the brighter frame, between whole levels where need be
    R : (K,) exposure ratios
    weight : (K,) weights
    """

    m: Indices
    T: F64
    R: F64
    weight: F64


def comparagram(A: ArrayLike, B: ArrayLike) -> Array:
    """Return J (256, 256), how many pixels have level m in A and z in B [Mann02]; frames (H, W), aligned."""
    a, b = to_256(as_stack([A, B])).reshape(2, -1).astype(np.intp)
    return np.bincount(a * 256 + b, minlength=65536).reshape(256, 256)


def build_equations(h: Array, times: F64, w: F64) -> Equations:
    """Return f^-1(m) = R f^-1(T(m)) of each two neighbors in exposure, from histograms h (P, n).

    The weight of an equation is the smaller weight of its two levels, times the square root of the
    fraction of pixels at level m.
    """
    z = np.arange(len(w))
    levels = []
    transferred = []
    ratios = []
    equation_weights = []
    for a, b in pairwise(np.argsort(times, kind="stable")):
        T = transfer.brightness_transfer(h[a], h[b])
        m = np.flatnonzero(np.isfinite(T) & (h[a] > 0) & (times[a] < times[b]))
        levels.append(m)
        transferred.append(T[m])
        ratios.append(np.full(len(m), times[a] / times[b]))
        fraction = h[a][m] / h[a].sum()
        equation_weights.append(np.minimum(w[m], np.interp(T[m], z, w)) * np.sqrt(fraction))
    return Equations(
        m=np.concatenate(levels),
        T=np.concatenate(transferred),
        R=np.concatenate(ratios),
        weight=np.concatenate(equation_weights),
    )


def build_pixel_equations(Z: Array, times: F64, w: F64) -> Equations:
    """Return the same equations from samples Z (N, P) of aligned frames, pixel by pixel.

    Debevec and Malik, and Mitsunaga and Nayar, start from pixels; here both can be compared with
    the equations from histograms.
    """
    order = np.argsort(times)
    pairs = [(a, b) for a, b in pairwise(order) if times[a] < times[b]]
    a, b = np.transpose(pairs)
    m = Z[:, a].ravel()
    T = Z[:, b].ravel()
    return Equations(
        m=m,
        T=T.astype(np.float64),
        R=np.tile(times[a] / times[b], len(Z)),
        weight=np.minimum(w[m], w[T]) / np.sqrt(len(Z)),
    )


def interpolate_levels(T: F64, n: int = 256) -> F64:
    """Return A (K, n) that interpolates: A @ g = g(T) for levels T between whole ones."""
    return np.maximum(1 - np.abs(T[:, None] - np.arange(n)), 0)


def solve_table(equations: Equations, w: F64, *, smoothness: float = 2.0) -> F64:
    """Return the table g (n,) that solves the equations by least squares, with g(n // 2) = 0.

    It minimizes sum weight^2 (g(T) - g(m) + ln R)^2 + sum (lambda w(z) (g - ln z)''(z))^2. The
    curvature is measured against that of a linear camera, because a logarithm is curved itself.
    Levels that no equation constrains take the value of the nearest level that one does.
    """
    if not np.any(equations.weight > 0) or not 0 < smoothness < np.inf:
        raise InputError(
            f"expected pixels that are well exposed in two photos, and smoothness > 0, got {smoothness}"
        )
    n = len(w)
    z = np.arange(n)
    g_T = interpolate_levels(equations.T, n)
    g_m = np.eye(n)[equations.m]
    data = equations.weight[:, None] * (g_T - g_m)
    penalty = weights.second_differences(w, smoothness)
    gauge = z == n // 2
    A = np.vstack([data, penalty, gauge])
    b_data = -equations.weight * np.log(equations.R)
    b_penalty = penalty @ np.log(np.maximum(z, 0.25))
    b = np.concatenate([b_data, b_penalty, [0]])
    g = np.linalg.lstsq(A, b)[0]
    constrained = A.any(axis=0)
    g = np.interp(z, z[constrained], g[constrained])
    return g - g[n // 2]


def solve_polynomial(equations: Equations, *, order: int = 10, n: int = 256) -> F64:
    """Return the c (N - 1,) that minimizes sum weight^2 (f^-1(m) - R f^-1(T))^2 [Grossberg03].

    f^-1(M) = M + sum_k c_k b_k(M) in the basis of `mitsunaga`: f^-1(0) = 0 and f^-1(1) = 1.
    """
    if not np.any(equations.weight > 0) or not 1 <= order <= 20:
        raise InputError(
            f"expected an order up to 20, and pixels that are well exposed in two photos, got {order}"
        )
    phi_m = terms(equations.m / (n - 1), order)
    phi_T = terms(equations.T / (n - 1), order)
    D = equations.weight[:, None] * (phi_m - equations.R[:, None] * phi_T)
    return np.asarray(np.linalg.lstsq(D[:, 1:], -D[:, 0])[0])


def recover(
    images: ArrayLike, times: ArrayLike, *, smoothness: float = 2.0, valid: ArrayLike | None = None
) -> F64:
    """Return the response g as a table, recovered from the frames' histograms, each channel by itself.

    The weights are the Gaussian, cut above 0.98 of the top level, where noise hides clipped pixels,
    and below 0.02. For other weights call `build_equations` and `solve_table`.

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
    times = as_times(times, len(stack), distinct=2)
    w = weights.cut(weights.gaussian(), below=0.02)
    curves = []
    for h in transfer.histograms(to_256(stack), valid):
        equations = build_equations(h, times, w)
        curves.append(solve_table(equations, w, smoothness=smoothness))
    g = np.stack(curves, axis=-1)
    return weights.make_monotone(g).reshape(256, *stack.shape[3:])


def recover_polynomial(
    images: ArrayLike, times: ArrayLike, *, order: int = 10, valid: ArrayLike | None = None
) -> F64:
    """Return the response g as the logarithm of a polynomial of order 1 to 20; see `recover`.

    The weights are the hat, which keeps the levels near both ends that a polynomial needs, cut
    above 0.98 of the top level.

    Raises
    ------
    ValueError
        As `recover`.
    """
    stack = as_stack(images)
    times = as_times(times, len(stack), distinct=2)
    w = weights.cut(weights.hat())
    curves = []
    for h in transfer.histograms(to_256(stack), valid):
        equations = build_equations(h, times, w)
        curves.append(curve(solve_polynomial(equations, order=order)))
    return np.stack(curves, axis=-1).reshape(256, *stack.shape[3:])
