"""The bilateral filter, fast on a coarse grid over place and level.

v        signal                (H, W), and g, w, k as in `core.filters.bilateral`
h        node spacing          pixels, odd, at most MAX_SPACING sigma_s
z        level of a node       low, low + step, ...: Z of them, step at most sigma_r / 2

With the level as a third axis, pixels that differ much are far from each other, and the filter is a
Gaussian blur of that space (Paris and Durand, ECCV 2006). A blurred space can be sampled at few
nodes.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F32, ArrayLike, NDArray, describe
from hdrlab.core.filters.bilateral import Filtered, require_signal
from hdrlab.errors import InputError
from hdrlab.fast import blur

# number of levels
MIN_LEVELS = 8
MAX_LEVELS = 1000
# of the nodes, relative to sigma_s
MAX_SPACING = 0.55
LEVELS_PER_SIGMA_R = 2
BINS_PER_LEVEL = 4
# a smaller closeness is set to 0, as the smallest numbers of float32 are slow
MIN_CLOSENESS = 1e-15
SMALLEST_DIVISOR = 1e-30


@dataclass(frozen=True)
class Axes:
    """The grid: spacing h, Y rows of X nodes, and Z levels, the lowest and their step."""

    h: int
    X: int
    Y: int
    low: float
    step: float
    Z: int
    sigma_s: float
    sigma_r: float


def _axes(v: F32, *, sigma_s: float, sigma_r: float) -> Axes:
    """Return the grid for v: node (j, i) lies on pixel (j h, i h), the last ones beyond the edge."""
    h = max(1, 2 * int((MAX_SPACING * sigma_s + 1) / 2) - 1)
    low = float(v.min())
    extent = float(np.ptp(v))
    step = min(sigma_r / LEVELS_PER_SIGMA_R, max(extent / MIN_LEVELS, SMALLEST_DIVISOR))
    max_extent = MAX_LEVELS * step
    if extent > max_extent:
        raise InputError(
            f"expected a range of at most {max_extent:g} for {sigma_r=}, got {describe(v)}"
        )
    return Axes(
        h=h,
        X=(v.shape[1] - 1) // h + 2,
        Y=(v.shape[0] - 1) // h + 2,
        low=low,
        step=step,
        Z=int(extent / step) + 2,
        sigma_s=sigma_s,
        sigma_r=sigma_r,
    )


def _histograms(v: F32, a: Axes) -> Iterator[F32]:
    """Yield the histograms (X, bins) of the h x h pixels around each node, row by row.

    A pixel counts in the two nearest bins, in proportion to its distance.
    """
    bins = a.Z * BINS_PER_LEVEL
    start = (np.arange(v.shape[1]) + a.h // 2) // a.h * bins
    for j in range(a.Y):
        rows = v[max(0, j * a.h - a.h // 2) : j * a.h + a.h // 2 + 1]
        t = (rows - np.float32(a.low)) * np.float32(BINS_PER_LEVEL / a.step)
        # a pixel is shared between the two bins beside it, and jumps from none to the next
        left = np.floor(t)
        index = (left.astype(np.intp) + start).ravel()
        right = np.bincount(index, (t - left).ravel(), a.X * bins)
        counts = np.bincount(index, minlength=a.X * bins) - right
        counts[1:] += right[:-1]
        yield counts.astype(np.float32).reshape(a.X, bins)


def _closeness(a: Axes) -> F32:
    """Return the matrix (bins, 2 Z) from a histogram to (sum w, sum w (v_q - z)) for each z."""
    v = np.arange(a.Z * BINS_PER_LEVEL) * (a.step / BINS_PER_LEVEL)
    z = np.arange(a.Z) * a.step
    d = v[:, None] - z
    w = np.exp(-(d**2) / (2 * a.sigma_r**2))
    w[w < MIN_CLOSENESS] = 0
    return np.concatenate([w, w * d], axis=1).astype(np.float32)


class Row(NamedTuple):
    """A row of nodes: k (X, Z), and mean - z (X, Z); the imaginary part is the rise to the next z."""

    k: F32
    away: NDArray[np.complex64]


def _nodes(v: F32, a: Axes) -> Iterator[Row]:
    """Yield the rows of nodes, from top to bottom: the histograms' sums, blurred along the picture.

    Cells of h pixels, and lines between nodes, are blurs themselves, of variance (h^2 - 1) / 12 and
    (h^2 - 1) / 6. Variances add, so the Gaussian along the nodes has the rest.
    """
    g = blur._taps((a.sigma_s**2 - (a.h**2 - 1) / 4) ** 0.5 / a.h)
    r = len(g) // 2
    w = _closeness(a)
    K = blur._band(g, blur.NODES_PER_TILE)
    # a ring buffer of the rows in reach: row j is at j mod len(g)
    recent = np.zeros((len(g), a.X * 2 * a.Z), np.float32)
    row = np.zeros((a.X + -a.X % blur.NODES_PER_TILE + 2 * r, 2 * a.Z), np.float32)
    counted = _histograms(v, a)
    area = np.float32(2 * np.pi * (a.sigma_s / a.h) ** 2)
    for j in range(a.Y + r):
        recent[j % len(g)] = 0
        if j < a.Y:
            row[r : r + a.X] = next(counted) @ w
            recent[j % len(g)] = blur._product(K, blur.NODES_PER_TILE, row)[: a.X].ravel()
        if j >= r:
            near = (np.roll(g, j + 1) @ recent).reshape(a.X, 2, a.Z)
            away = near[:, 1] / np.maximum(near[:, 0], SMALLEST_DIVISOR)  # 0 where nothing is near
            rise = np.diff(away, append=away[:, -1:])
            yield Row(near[:, 0] * area, away + np.complex64(1j) * rise)


def _read(v: F32, a: Axes, above: Row, below: Row) -> Filtered:
    """Return mean and k of the h rows v between two rows of nodes.

    The mean is read along lines between the nodes, k at a node nearby: it is right to about a
    tenth.
    """
    y = np.arange(len(v))[:, None]
    x = np.arange(v.shape[1])
    z = (v - np.float32(a.low)) * np.float32(1 / a.step)
    level = np.floor(z)
    first = above.away.view(np.float32).ravel()
    last = below.away.view(np.float32).ravel()
    away = (y / a.h).astype(np.float32) * (last - first)
    away += first
    place = level.astype(np.intp) + x // a.h * a.Z
    at = place + y * (a.X * a.Z)
    there = away.view(np.complex64).ravel()
    left = there.take(at, mode="clip").view(np.float32)
    right = there[a.Z :].take(at, mode="clip").view(np.float32)
    right -= left
    right *= np.repeat(x % a.h / a.h, 2).astype(np.float32)
    left += right
    z -= level
    z *= left[:, 1::2]
    z += left[:, ::2]
    z += v
    place += (x % a.h > a.h // 2) * a.Z
    near = a.h // 2 + 1
    return Filtered(z, np.concatenate([above.k.take(place[:near]), below.k.take(place[near:])]))


def bilateral(v: ArrayLike, *, sigma_s: float, sigma_r: float) -> Filtered:
    """Return the bilateral filter of the lesson, with an RMS error of the mean below 0.01 sigma_r.

    The wider sigma_s, the fewer nodes and the faster. A signal of over 500 sigma_r is a ValueError.

    References
    ----------
    Paris and Durand, A fast approximation of the bilateral filter, ECCV 2006.
    """
    v = np.asarray(v, np.float32)
    require_signal(v, sigma_s=sigma_s, sigma_r=sigma_r)
    a = _axes(v, sigma_s=sigma_s, sigma_r=sigma_r)
    mean = np.empty_like(v)
    k = np.empty_like(v)
    for j, (above, below) in enumerate(pairwise(_nodes(v, a))):
        rows = slice(j * a.h, (j + 1) * a.h)
        mean[rows], k[rows] = _read(v[rows], a, above, below)
    return Filtered(mean, k)
