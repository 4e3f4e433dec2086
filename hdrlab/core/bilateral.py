"""The bilateral filter: by its definition, and fast on a coarse grid over place and level.

v        signal                (H, W), such as log luminance; nothing beyond its edge has weight
g        closeness in space    of pixels p and q, exp(-|p - q|^2 / (2 sigma_s^2)), sigma_s in pixels
w        closeness in range    exp(-(v_q - v_p)^2 / (2 sigma_r^2)), sigma_r in the unit of v
k        weight of all         (H, W), sum of g w: how many pixels a mean rests on, 1 to 2 pi sigma_s^2
h        node spacing          pixels, odd, at most sigma_s / 2
z        level of a node       low, low + step, ...: Z of them, step at most sigma_r / 2

Take the level as a third axis, and what differs much is far away: the filter is a Gaussian blur of that space
(Paris and Durand, ECCV 2006), and what is blurred is known from few nodes.
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core import blur
from hdrlab.core.arrays import describe

Float = NDArray[np.float32]

FAR = 1e9  # beyond the edge: too different from any pixel to have weight
FEW, MANY = 8, 1000  # levels in all
LEVELS, BINS = 2, 4  # levels per sigma_r, at least, and bins of a histogram per level
NOTHING, TINY = 1e-15, 1e-30  # a closeness below 1e-15 is none: the least numbers of float32 are slow


class Filtered(NamedTuple):
    """Attributes: mean (H, W), v smoothed but for its edges; k (H, W), the pixels that each mean rests on."""

    mean: Float
    k: Float


def brute(v: ArrayLike, *, sigma_s: float, sigma_r: float) -> Filtered:
    """Return mean = 1/k sum_q g w v_q, k = sum_q g w, over a square of 3 sigma_s [Battiato08 eq. 1.31]."""
    v = _signal(v, sigma_s, sigma_r).astype(np.float64)
    (H, W), r = v.shape, int(np.ceil(3 * sigma_s))
    around = np.pad(v, r, constant_values=FAR)
    total, k = np.zeros((H, W)), np.zeros((H, W))
    for dy in range(-r, r + 1):
        for dx in range(-r, r + 1):
            q = around[r + dy : r + dy + H, r + dx : r + dx + W]
            g = np.exp(-(dx**2 + dy**2) / (2 * sigma_s**2))
            gw = g * np.exp(-((q - v) ** 2) / (2 * sigma_r**2))
            total += gw * q
            k += gw
    return Filtered((total / k).astype(np.float32), k.astype(np.float32))


class Axes(NamedTuple):
    """The grid: spacing h, Y rows of X nodes, and Z levels, the lowest and their step."""

    h: int
    X: int
    Y: int
    low: float
    step: float
    Z: int
    sigma_s: float
    sigma_r: float


def axes(v: Float, *, sigma_s: float, sigma_r: float) -> Axes:
    """Return the grid that holds v: node (j, i) lies on pixel (j h, i h), the last ones beyond the edge."""
    h = max(1, 2 * int((sigma_s / 2 + 1) / 2) - 1)
    low, extent = float(v.min()), float(np.ptp(v))
    step = min(sigma_r / LEVELS, max(extent / FEW, TINY))
    if extent > MANY * step:
        raise ValueError(f"expected a range of at most {MANY * step:g} for {sigma_r=}, got {describe(v)}")
    Y, X = ((n - 1) // h + 2 for n in v.shape)
    return Axes(h, X, Y, low, step, int(extent / step) + 2, sigma_s, sigma_r)


def histograms(v: Float, a: Axes) -> Iterator[Float]:
    """Yield for each row of nodes the histograms (X, bins) of the h x h pixels around them, bins shared."""
    bins = a.Z * BINS
    start = (np.arange(v.shape[1]) + a.h // 2) // a.h * bins
    for j in range(a.Y):
        rows = v[max(0, j * a.h - a.h // 2) : j * a.h + a.h // 2 + 1]
        t = (rows - np.float32(a.low)) * np.float32(BINS / a.step)
        left = np.floor(
            t
        )  # a pixel is shared between the two bins beside it, and jumps from none to the next
        index = (left.astype(np.intp) + start).ravel()
        right = np.bincount(index, (t - left).ravel(), a.X * bins)
        counts = np.bincount(index, minlength=a.X * bins) - right
        counts[1:] += right[:-1]
        yield counts.astype(np.float32).reshape(a.X, bins)


def closeness(a: Axes) -> Float:
    """Return the matrix (bins, 2 Z) that takes a histogram to (sum of w, sum of w (v_q - z)) for each z."""
    v, z = np.arange(a.Z * BINS) * (a.step / BINS), np.arange(a.Z) * a.step
    d = v[:, None] - z
    w = np.exp(-(d**2) / (2 * a.sigma_r**2))
    w[w < NOTHING] = 0
    return np.concatenate([w, w * d], axis=1).astype(np.float32)


class Row(NamedTuple):
    """A row of nodes: k (X, Z), and mean - z (X, Z) with its rise to the next z as imaginary part."""

    k: Float
    away: NDArray[np.complex64]


def nodes(v: Float, a: Axes) -> Iterator[Row]:
    """Yield the rows of nodes, from top to bottom: the histograms' sums, blurred along the picture.

    Cells of h pixels, and lines between nodes, are blurs themselves, of variance (h^2 - 1) / 12 and
    (h^2 - 1) / 6. Variances add: the Gaussian along the nodes takes what is left.
    """
    g = blur.taps((a.sigma_s**2 - (a.h**2 - 1) / 4) ** 0.5 / a.h)
    r, w, K = len(g) // 2, closeness(a), blur.band(g, blur.NODES)
    recent = np.zeros((len(g), a.X * 2 * a.Z), np.float32)  # the rows in reach; row j stands at j mod len(g)
    row = np.zeros((a.X + -a.X % blur.NODES + 2 * r, 2 * a.Z), np.float32)
    counted, area = histograms(v, a), np.float32(2 * np.pi * (a.sigma_s / a.h) ** 2)
    for j in range(a.Y + r):
        recent[j % len(g)] = 0
        if j < a.Y:
            row[r : r + a.X] = next(counted) @ w
            recent[j % len(g)] = blur.product(K, blur.NODES, row)[: a.X].ravel()
        if j >= r:
            near = (np.roll(g, j + 1) @ recent).reshape(a.X, 2, a.Z)
            away = near[:, 1] / np.maximum(near[:, 0], TINY)  # 0 where nothing is near
            rise = np.diff(away, append=away[:, -1:])
            yield Row(near[:, 0] * area, away + np.complex64(1j) * rise)


def read(v: Float, a: Axes, above: Row, below: Row) -> Filtered:
    """Return mean and k of the h rows v between two rows of nodes, each pixel at its place and level.

    The mean is read along lines between the nodes, k at a node nearby: it is right to about a tenth.
    """
    y, x = np.ogrid[: len(v), : v.shape[1]]
    z = (v - np.float32(a.low)) * np.float32(1 / a.step)
    level = np.floor(z)
    first, last = (row.away.view(np.float32).ravel() for row in (above, below))
    away = (first + (y / a.h).astype(np.float32) * (last - first)).view(np.complex64)
    place = level.astype(np.intp) + x // a.h * a.Z
    at = place + y * (a.X * a.Z)
    left, right = (away.take(i, mode="clip").view(np.float32) for i in (at, at + a.Z))
    left += np.repeat(x % a.h / a.h, 2, axis=1).astype(np.float32) * (right - left)
    place += (x % a.h > a.h // 2) * a.Z
    near = a.h // 2 + 1
    k = np.concatenate([above.k.take(place[:near]), below.k.take(place[near:])])
    return Filtered(v + (left[:, ::2] + (z - level) * left[:, 1::2]), k)


def fast(v: ArrayLike, *, sigma_s: float, sigma_r: float) -> Filtered:
    """Return the bilateral filter of v by way of the grid, its mean right to 0.01 sigma_r (root mean square).

    Parameters
    ----------
    v : (H, W), finite
    sigma_s : standard deviation in space, pixels; the wider, the fewer nodes and the faster
    sigma_r : standard deviation in range, unit of v

    Returns
    -------
    Filtered, the mean and its weight k, each (H, W) float32

    Raises
    ------
    ValueError
        For a signal of another shape, not finite or over 500 sigma_r long, and sigmas that are not positive.

    References
    ----------
    Paris and Durand, A fast approximation of the bilateral filter, ECCV 2006.

    Examples
    --------
    >>> step = np.where(np.arange(40) < 20, 0, 3) * np.ones((30, 1))
    >>> bool(np.allclose(fast(step, sigma_s=8, sigma_r=0.4).mean, step, atol=1e-3))
    True
    """
    v = _signal(v, sigma_s, sigma_r)
    a = axes(v, sigma_s=sigma_s, sigma_r=sigma_r)
    mean, k = np.empty_like(v), np.empty_like(v)
    for j, (above, below) in enumerate(pairwise(nodes(v, a))):
        rows = slice(j * a.h, (j + 1) * a.h)
        mean[rows], k[rows] = read(v[rows], a, above, below)
    return Filtered(mean, k)


def _signal(v: ArrayLike, sigma_s: float, sigma_r: float) -> Float:
    v = np.asarray(v, np.float32)
    if v.ndim != 2 or 0 in v.shape or not np.isfinite(v).all():
        raise ValueError(f"expected a finite signal (H, W), got {describe(v)}")
    if not (0 < sigma_s < np.inf and 0 < sigma_r < np.inf):
        raise ValueError(f"expected sigmas above 0, got sigma_s={sigma_s} and sigma_r={sigma_r}")
    return v
