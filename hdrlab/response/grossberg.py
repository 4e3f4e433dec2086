"""The response from histograms alone (Grossberg and Nayar, PAMI 2003; Cerman and Hlavac 2006, sec. 4).

h   histogram                     (n,) of a frame
J   comparagram                   (n, n), pixels with level m in frame A and z in frame B: frames aligned
T   brightness transfer function  (n,), the level in B of what has level m in A: see `core.transfer`
R   ratio of exposures            t_A / t_B < 1
f   f^-1                          (n,), exposure of each level;  g = ln f

All that two frames say of the response is T, for f(m) = R f(T(m)): the ridge of their comparagram. And T is
found without comparing pixels, since it takes ranks to ranks; so the frames need not be aligned, and noise
averages out. Two models of f take these equations: a table, as Debevec and Malik's, and a polynomial,
Mitsunaga and Nayar's. From noisy pixels a polynomial of high order fails; from histograms, without the levels
above the cut, it does not.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core import weights
from hdrlab.core.arrays import as_mask, as_stack, as_table, as_times, to_256
from hdrlab.core.transfer import histogram, mid_step
from hdrlab.core.weights import make_monotone, second_differences
from hdrlab.response import linear
from hdrlab.response.polynomial import basis, curve

Float = NDArray[np.float64]
WEIGHTS = {
    "table": lambda: weights.cut(weights.gaussian(), below=0.02),
    "polynomial": lambda: weights.cut(weights.hat()),
}


class Equations(NamedTuple):
    """f(m) = R f(T), each with a weight; m (K,) whole levels, T (K,) between levels, R and weight (K,)."""

    m: NDArray[np.intp]
    T: Float
    R: Float
    weight: Float


def comparagram(A: ArrayLike, B: ArrayLike) -> NDArray[np.int64]:
    """Return J (256, 256), how many pixels have level m in A and z in B [Mann02]; frames (H, W), aligned."""
    a, b = to_256(as_stack([A, B])).reshape(2, -1).astype(np.intp)
    return np.bincount(a * 256 + b, minlength=65536).reshape(256, 256)


def histograms(images: ArrayLike, valid: ArrayLike | None = None) -> list[NDArray[np.int64]]:
    """Return h (P, 256) of each channel, over the pixels that hold a picture in every frame."""
    stack = as_stack(images)
    mask = as_mask(valid, stack)
    shown = slice(None) if mask is None else mask.all(axis=0).ravel()
    pixels = to_256(stack).reshape(len(stack), stack.shape[1] * stack.shape[2], -1)[:, shown]
    return [np.stack([histogram(Z, 256) for Z in pixels[..., c]]) for c in range(pixels.shape[-1])]


def equations(h: ArrayLike, times: ArrayLike, w: ArrayLike) -> Equations:
    """Return what each two frames next to each other in exposure say, from histograms h (P, n).

    An equation weighs as much as the lighter of its two levels, and as many pixels as stand at level m.
    """
    h, t, w = np.asarray(h), np.asarray(times, np.float64), np.asarray(w, np.float64)
    if len(np.unique(t)) < 2:
        raise ValueError(f"expected photographs with at least two different times, got {t.tolist()} s")
    found = []
    for a, b in pairwise(np.argsort(t, kind="stable")):
        T = mid_step(h[a], h[b])
        m = np.flatnonzero(np.isfinite(T) & (h[a] > 0) & (t[a] < t[b]))
        least = np.minimum(w[m], np.interp(T[m], np.arange(len(w)), w))
        weight = least * np.sqrt(h[a][m] / h[a].sum())
        found.append(Equations(m, T[m], np.full(len(m), t[a] / t[b]), weight))
    together = Equations._make(np.concatenate(column) for column in zip(*found, strict=True))
    return weighing(together)


def pixel_equations(Z: ArrayLike, times: ArrayLike, w: ArrayLike) -> Equations:
    """Return the same from samples Z (N, P) of aligned frames, as both methods have it at first."""
    Z, t, w = np.asarray(Z), np.asarray(times, np.float64), np.asarray(w, np.float64)
    a, b = np.transpose([pair for pair in pairwise(np.argsort(t, kind="stable")) if t[pair[0]] < t[pair[1]]])
    m, T = Z[:, a].ravel(), Z[:, b].ravel()
    weight = np.minimum(w[m], w[T]) / np.sqrt(len(Z))
    found = Equations(m, T.astype(np.float64), np.tile(t[a] / t[b], len(Z)), weight)
    return weighing(found)


def weighing(found: Equations) -> Equations:
    """Return those of the equations that have a weight."""
    return Equations._make(column[found.weight > 0] for column in found)


def rows_at(T: ArrayLike, n: int = 256) -> Float:
    """Return A (K, n), A @ g = g(T) for levels T between whole ones."""
    T = np.asarray(T, np.float64)
    below = np.minimum(T.astype(np.intp), n - 2)
    A, k = np.zeros((len(T), n)), np.arange(len(T))
    A[k, below], A[k, below + 1] = below + 1 - T, T - below
    return A


def table(found: Equations, w: ArrayLike, *, smoothness: float = 2.0) -> Float:
    """Return g (n,), the least of sum weight^2 (g(T) - g(m) + ln R)^2 + sum (lambda w(z) (g - ln z)''(z))^2.

    g(n // 2) = 0. The bends are those away from a linear camera, for a logarithm has bends of its own.
    """
    w = np.asarray(w, np.float64)
    n = len(w)
    data = found.weight[:, None] * (rows_at(found.T, n) - np.eye(n)[found.m])
    bends = second_differences(w, smoothness)
    A, b = (
        np.concatenate([data, bends]),
        np.concatenate([-found.weight * np.log(found.R), bends @ linear.curve(n)]),
    )
    reached = np.any(A != 0, axis=0) | (np.arange(n) == n // 2)
    free = np.flatnonzero(reached & (np.arange(n) != n // 2))
    g = np.zeros(n)
    g[free] = np.linalg.lstsq(A[:, free], b, rcond=None)[0]
    return np.interp(np.arange(n), np.flatnonzero(reached), g[reached])


def polynomial(found: Equations, *, order: int = 10, n: int = 256) -> Float:
    """Return c (N - 1,) that minimises sum weight^2 (f(m) - R f(T))^2, f(M) = M + sum c b(M) [Grossberg03].

    The basis is that of `response.polynomial`: f(0) = 0 and f(1) = 1 hold whatever c.
    """
    M, MT = found.m / (n - 1), found.T / (n - 1)
    A = basis(M, order) - found.R[:, None] * basis(MT, order)
    return np.asarray(
        np.linalg.lstsq(found.weight[:, None] * A, found.weight * (found.R * MT - M), rcond=None)[0]
    )


def recover(
    images: ArrayLike,
    times: ArrayLike,
    *,
    model: str = "table",
    smoothness: float = 2.0,
    order: int = 10,
    w: ArrayLike | None = None,
    valid: ArrayLike | None = None,
) -> Float:
    """Return the response g recovered from the frames' histograms, each channel by itself.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs of the same light, not necessarily aligned; 16 bits are read at 256 levels.
    times : (P,) float
        Exposure times in seconds, at least two different ones.
    model : {"table", "polynomial"}
        The histogram version of Debevec and Malik's method, or that of Mitsunaga and Nayar's.
    smoothness : float
        lambda of the table.
    order : int
        N of the polynomial, 1 to 20.
    w : (256,) float, optional
        Weights; for the table the Gaussian, for the polynomial, which needs the ends, the hat; both without
        the levels above 0.98 of the top one, where noise hides clipped pixels.
    valid : (P, H, W) bool, optional
        False where a photograph holds no picture.

    Returns
    -------
    (256,) or (256, 3) float64
        g, the ln exposure of each level, never falling; g[128] = 0.

    Raises
    ------
    ValueError
        For photographs whose histograms do not overlap between two exposures, and arrays that are no bracket.

    References
    ----------
    Grossberg and Nayar, Determining the camera response from images: what is knowable?, PAMI 25(11), 2003.
    Cerman and Hlavac, Exposure time estimation for high dynamic range imaging with hand held camera, 2006.

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
    times = as_times(times, len(stack))
    if model not in WEIGHTS or not 0 < smoothness < np.inf or not 1 <= order <= 20:
        got = f"{model!r}, {smoothness} and {order}"
        raise ValueError(
            f"expected a model table or polynomial, positive smoothness and an order to 20, got {got}"
        )
    w = WEIGHTS[model]() if w is None else as_table(w, 256)
    curves = []
    for h in histograms(stack, valid):
        found = equations(h, times, w)
        if len(found.m) == 0:
            raise ValueError("expected levels seen well in two exposures; the histograms have none")
        curves.append(
            table(found, w, smoothness=smoothness)
            if model == "table"
            else curve(polynomial(found, order=order))
        )
    return make_monotone(np.stack(curves, axis=-1)).reshape(256, *stack.shape[3:])
