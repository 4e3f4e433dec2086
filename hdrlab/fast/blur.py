"""Gaussian blurs as matrix products: exact if narrow, on a coarse grid if wide.

image  (H, W) float32, continued beyond its edges by reflection
sigma  standard deviation, pixels
k      taps (2r + 1,) of the kernel, sum 1; r = 4 sigma, on the coarse grid 5
K      band matrix (n, (n - 1) step + 2r + 1), K[i, i step + j] = k[j]: row i has the kernel of output i
h      spacing of the coarse grid, pixels

A blur of rows is a product with a band matrix, the same at every height. Cut into tiles of a few
rows it is small and dense, which is what a processor's matrix product does at full speed; a loop
over the taps does not.
"""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from hdrlab.core.arrays import F32, ArrayLike
from hdrlab.errors import InputError

# with more rows, more of the band's zeros are multiplied; with fewer, the processor idles
TILE_ROWS = 16
# rows of a product on the coarse grid
NODES_PER_TILE = 8


def gaussian(image: ArrayLike, sigma: float) -> F32:
    """Return the lesson's blur.

    Below sigma = 4 it is the plain sum to the accuracy of float32. Wider ones go over a coarse
    grid, and their kernel differs from the Gaussian by less than 0.2 % of its peak.
    """
    image = np.asarray(image, np.float32)
    if image.ndim != 2 or 0 in image.shape or not 0 < sigma < np.inf:
        raise InputError(
            f"expected an image (H, W) and a positive sigma, got shape {image.shape}, {sigma=}"
        )
    if sigma < 4:
        return _direct(image, sigma)
    largest_power_of_two = 2 ** int(np.log2(sigma / 2))
    return _coarse(image, sigma, largest_power_of_two)


def _taps(sigma: float, *, reach: float = 4) -> F32:
    """Return k[j] = exp(-(j - r)^2 / (2 sigma^2)), divided by its sum, to `reach` sigma on each side."""
    r = int(reach * sigma + 0.5)
    k = np.exp(-0.5 * (np.arange(-r, r + 1) / sigma) ** 2)
    return (k / k.sum()).astype(np.float32)


def _band(k: ArrayLike, n: int, step: int = 1) -> F32:
    """Return the band matrix K of n rows, each holding the taps k `step` columns further right."""
    k = np.asarray(k, np.float32)
    K = np.zeros((n, (n - 1) * step + len(k)), np.float32)
    for i in range(n):
        K[i, i * step : i * step + len(k)] = k
    return K


def _spline(h: int, n: int) -> F32:
    """Return the matrix (n h, n + 3) that puts h rows between each two nodes by cubic B-splines."""
    t = np.arange(h) / h
    cubics = [(1 - t) ** 3, 4 - 6 * t**2 + 3 * t**3, 1 + 3 * t + 3 * t**2 - 3 * t**3, t**3]
    U = np.zeros((n * h, n + 3), np.float32)
    for i in range(n):
        U[i * h : (i + 1) * h, i : i + 4] = np.stack(cubics, axis=-1) / 6
    return U


def _product(K: F32, step: int, image: F32) -> F32:
    """Return the products of K with windows of rows of `image`, one every `step` rows, stacked."""
    windows = sliding_window_view(image, K.shape[1], axis=0)[::step]
    rows = windows.swapaxes(1, 2)  # (windows, rows, W)
    return np.matmul(K, rows).reshape(-1, image.shape[1])


def _pad(image: F32, margin: int) -> F32:
    """Return `image` padded by reflection: by `margin`, and at the far ends up to whole tiles."""
    return np.pad(image, [(margin, margin + -n % TILE_ROWS) for n in image.shape], mode="symmetric")


def _inside(padded: F32, k: F32, margin: int) -> F32:
    """Return the blur by taps k of the part of `padded` inside `margin`, in whole tiles."""
    K = _band(k, TILE_ROWS)
    cut = margin - len(k) // 2
    core = padded[cut : len(padded) - cut, cut : padded.shape[1] - cut]
    return _product(K, TILE_ROWS, np.ascontiguousarray(_product(K, TILE_ROWS, core).T)).T


def _direct(image: F32, sigma: float) -> F32:
    """Return the plain blur."""
    k = _taps(sigma)
    margin = len(k) // 2
    # lying on its side, to come out with its rows in one piece
    blurred = _inside(_pad(image, margin).T, k, margin).T
    return np.ascontiguousarray(blurred[: image.shape[0], : image.shape[1]])


def _coarse(image: F32, sigma: float, h: int) -> F32:
    """Return the blur through a grid of spacing h: blurred at its nodes, then cubic B-splines between.

    A cubic B-spline is itself nearly a Gaussian, of variance h^2 / 3. Variances add, so the nodes
    are blurred by the rest. Their kernel reaches five sigma, because beside a lamp that is a
    million times as bright most of the light comes from the tail.
    """
    k = _taps((sigma**2 - h**2 / 3) ** 0.5, reach=5)
    nodes_down = _sampled(image, k, h)
    nodes = _sampled(np.ascontiguousarray(nodes_down.T), k, h)  # (nodes across, nodes down)
    U = _spline(h, NODES_PER_TILE)
    W = image.shape[1]
    across = np.ascontiguousarray(_product(U, NODES_PER_TILE, nodes)[:W].T)  # (nodes down, W)
    blurred = np.empty_like(image)
    for first in range(0, -(-len(image) // h), NODES_PER_TILE):
        rows = blurred[first * h : (first + NODES_PER_TILE) * h]
        np.matmul(U[: len(rows)], across[first : first + NODES_PER_TILE + 3], out=rows)
    return blurred


def _sampled(image: F32, k: F32, h: int) -> F32:
    """Return the blur by taps k down the columns, at a node before the first row and every h rows.

    Reflection folds the ends of the band matrix inward, so the image needs no padding.
    """
    K = _band(k, NODES_PER_TILE, h)
    n = len(image)
    tile_count = -(-n // (NODES_PER_TILE * h)) + 1
    nodes = np.empty((NODES_PER_TILE * tile_count, image.shape[1]), np.float32)
    for first in range(0, len(nodes), NODES_PER_TILE):
        position = (np.arange(K.shape[1]) + (first - 1) * h - len(k) // 2) % (2 * n)
        rows = np.minimum(position, 2 * n - 1 - position)  # reflected
        low = rows.min()
        high = rows.max() + 1
        folded = K
        if not np.array_equal(rows, np.arange(low, high)):
            folded = np.zeros((NODES_PER_TILE, high - low), np.float32)
            np.add.at(folded.T, rows - low, K.T)
        np.matmul(folded, image[low:high], out=nodes[first : first + NODES_PER_TILE])
    return nodes
