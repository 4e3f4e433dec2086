"""Image pyramids (Burt and Adelson, IEEE Transactions on Communications 31(4), 1983).

image  (..., H, W) float32; colour lies in planes, (3, H, W)
w      weights of the kernel, (1 4 6 4 1) / 16 along either axis
g_k    level k of the Gaussian pyramid, (..., ceil(H / 2^k), ceil(W / 2^k)); g_0 is the image
L_k    level k of the Laplacian pyramid: what g_k holds beyond the expanded g_(k+1)

Pixel i of a level lies over pixel 2 i of the next finer one. Beyond its ends a level is continued
by reflection about its first and last pixels; only where `expand` needs one after the last, that is
repeated.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from scipy.ndimage import correlate1d, map_coordinates

from hdrlab.core.arrays import F32, Array
from hdrlab.errors import InputError

KERNEL = np.array([1, 4, 6, 4, 1]) / 16


def reduce(image: F32) -> F32:
    """Return g_(k+1)(i) = sum_m w(m) g_k(2 i + m), m = -2 ... 2, along both axes [Burt83 eq. 1].

    Sides are halved, and rounded up where they are odd.
    """
    if np.ndim(image) < 2:
        raise InputError(f"expected an image (..., H, W), got shape {np.shape(image)}")
    rows = correlate1d(image, KERNEL, axis=-2, mode="mirror")[..., ::2, :]
    return correlate1d(rows, KERNEL, axis=-1, mode="mirror")[..., ::2]


def expand(image: F32, shape: Sequence[int]) -> F32:
    """Return 2 sum_m w(m) g_k((i - m) / 2), only whole (i - m) / 2 counted, along both axes [Burt83 eq. 2].

    The last two of `shape` are the sides of the finer level.
    """
    if image.shape[-2:] != half_shape(shape):
        raise InputError(f"expected sides {half_shape(shape)}, half of {shape}, got {image.shape}")
    rows = _expand_rows(image, shape[-2])
    return _expand_rows(rows.swapaxes(-2, -1), shape[-1]).swapaxes(-2, -1)


def _expand_rows(g: F32, n: int) -> Array:
    """Return n rows: an even row is (1 6 1) / 8 of three coarse ones, an odd row the mean of two."""
    before = g[..., :2, :][..., -1:, :]
    after = g[..., -1:, :]
    g = np.concatenate([before, g, after], axis=-2)
    even = (g[..., :-2, :] + 6 * g[..., 1:-1, :] + g[..., 2:, :]) / 8
    odd = (g[..., 1:-1, :] + g[..., 2:, :]) / 2
    return np.stack([even, odd], axis=-2).reshape(*g.shape[:-2], -1, g.shape[-1])[..., :n, :]


def interpolate(image: F32, shape: Sequence[int]) -> F32:
    """Return `image` (H, W) at the next finer level, of this shape, by linear interpolation."""
    return map_coordinates(image, np.indices(shape) / 2, order=1, mode="nearest")


def gaussian(image: F32, levels: int) -> list[F32]:
    """Return the Gaussian pyramid g_0, g_1, ... of `levels` levels, or fewer if one is a single pixel."""
    pyramid = [np.asarray(image, np.float32)]
    while len(pyramid) < levels and pyramid[-1].shape[-2:] != (1, 1):
        pyramid.append(reduce(pyramid[-1]))
    return pyramid


def laplacian(image: F32, levels: int) -> list[F32]:
    """Return the Laplacian pyramid: L_k = g_k - expand(g_(k+1)), and last the coarsest g [Burt83 eq. 3]."""
    pyramid = gaussian(image, levels)
    return [fine - expand(coarse, fine.shape) for fine, coarse in pairwise(pyramid)] + pyramid[-1:]


def collapse(pyramid: Sequence[F32]) -> F32:
    """Return g_0 by g_k = L_k + expand(g_(k+1)), coarse to fine: `laplacian` undone [Burt83 eq. 4].

    Examples
    --------
    >>> image = np.random.default_rng(0).random((5, 6), np.float32)
    >>> bool(np.allclose(collapse(laplacian(image, 3)), image))
    True
    """
    image = pyramid[-1]
    for detail in reversed(pyramid[:-1]):
        image = detail + expand(image, detail.shape)
    return image


def depth(shape: Sequence[int], smallest: int) -> int:
    """Return the number of levels until another would have a side below `smallest` (>= 2) pixels."""
    return max(1, ((min(shape[-2:]) - 1) // (smallest - 1)).bit_length())


def half_shape(shape: Sequence[int]) -> tuple[int, int]:
    """Return the sides of the next coarser level."""
    return (shape[-2] + 1) // 2, (shape[-1] + 1) // 2
