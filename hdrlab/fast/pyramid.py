"""Image pyramids as matrix products in tiles, a few rows of tiles at a time: see `core.pyramid`.

K  band matrix, the rows of which hold the weights: a tile of rows is K times the rows it is made of
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from hdrlab.core import pyramid
from hdrlab.core.pyramid import depth, half_shape  # noqa: F401
from hdrlab.core.types import F32, Indices
from hdrlab.fast import with_parts
from hdrlab.fast.blur import _band

_Band = tuple[slice, F32]  # rows of a picture, and their values

_TILE = 8  # coarse rows and columns of a product: twice as many would double its zeros
_SLAB = 16  # tiles of rows at a time, which stay in the processor's cache
_BURT = (1, 6, 1)  # eighths: an even fine pixel from the coarse ones before, over and after it
_LINEAR = (0, 8, 0)  # eighths: an even fine pixel is the coarse one over it


def reduce(image: F32) -> F32:
    """Return g_(k+1)(i) = sum_m w(m) g_k(2 i + m), m = -2 ... 2, along both axes [Burt83 eq. 1]."""
    K = _band(pyramid.KERNEL, _TILE, 2)
    rows, columns = (np.pad(np.arange(n), (2, -n % (2 * _TILE) + 1), "reflect") for n in image.shape[-2:])
    g = np.empty((*image.shape[:-2], *half_shape(image.shape)), np.float32)
    for band, values in _bands(K, 2 * _TILE, image, rows, columns, g.shape):
        g[..., band, :] = values
    return g


def interpolate(image: F32, shape: Sequence[int]) -> F32:
    """Return `image` (H, W) at the next finer level, of this shape, by linear interpolation."""
    fine = np.empty(shape, np.float32)
    for band, values in _finer(image, shape, _LINEAR):
        fine[band] = values
    return fine


gaussian = with_parts(__name__, pyramid.gaussian, reduce=reduce)


def laplacian(image: F32, levels: int) -> list[F32]:
    """Return L_k = g_k - expand(g_(k+1)), and last the coarsest g itself [Burt83 eq. 3]."""
    g = gaussian(image, levels)
    return [_combine(np.subtract, fine, coarse) for fine, coarse in pairwise(g)] + g[-1:]


def collapse(pyramid: Sequence[F32]) -> F32:
    """Return g_0 by g_k = L_k + expand(g_(k+1)), coarse to fine: `laplacian` undone [Burt83 eq. 4]."""
    image = pyramid[-1]
    for detail in reversed(pyramid[:-1]):
        image = _combine(np.add, detail, image)
    return image


def _combine(operation: np.ufunc, fine: F32, coarse: F32) -> F32:
    """Return operation(fine, expand(coarse)), band by band, each while it is in the processor's cache."""
    result = np.empty_like(fine)
    for band, values in _finer(coarse, fine.shape, _BURT):
        operation(fine[..., band, :], values, out=result[..., band, :])
    return result


def _finer(image: F32, shape: Sequence[int], weights: Sequence[float]) -> Iterator[_Band]:
    """Yield the next finer level in bands: an even row by `weights`, an odd one half and half."""
    K = np.zeros((2 * _TILE, _TILE + 2), np.float32)
    for i in range(_TILE):
        K[2 * i, i : i + 3] = np.divide(weights, 8)
        K[2 * i + 1, i + 1 : i + 3] = 0.5
    begun = (np.pad(np.arange(n), (1, 0), "reflect") for n in image.shape[-2:])
    rows, columns = (np.pad(i, (0, -(len(i) - 1) % _TILE + 1), "edge") for i in begun)
    return _bands(K, _TILE, image, rows, columns, shape)


def _bands(
    K: F32, step: int, image: F32, rows: Indices, columns: Indices, shape: Sequence[int]
) -> Iterator[_Band]:
    """Yield K image[rows, columns] K^T, cut to `shape`, as rows and their values, from top to bottom.

    It is done in tiles, a window every `step` pixels along both axes, and a few tiles of rows at a time.
    """
    tile, reach = K.shape
    planes = image.reshape(-1, *image.shape[-2:])
    across = np.ascontiguousarray(K.T)  # in one piece, so that its products go to BLAS: five times as fast
    count = max(1, _SLAB // len(planes))
    for top in range(0, shape[-2], count * tile):
        slab = planes[:, rows[top // tile * step :][: (count - 1) * step + reach]]
        windows = sliding_window_view(slab, reach, axis=1)[:, ::step].swapaxes(2, 3)  # (C, tiles, reach, W)
        tall = np.matmul(K, windows).reshape(len(planes), -1, slab.shape[2])
        windows = sliding_window_view(_extend(tall, columns), reach, axis=2)[:, :, ::step]
        wide = np.empty((*windows.shape[:3], tile), np.float32)  # (C, h, tiles, tile)
        np.matmul(windows.swapaxes(1, 2), across, out=wide.swapaxes(1, 2))
        band = slice(top, min(top + wide.shape[1], shape[-2]))
        values = wide.reshape(*image.shape[:-2], wide.shape[1], -1)
        yield band, values[..., : band.stop - top, : shape[-1]]


def _extend(planes: F32, columns: Indices) -> F32:
    """Return planes[:, :, columns]: these are all columns in turn, with some before them and some after."""
    before, W = int(np.argmin(columns)), planes.shape[2]
    whole = np.empty((*planes.shape[:2], len(columns)), np.float32)
    whole[:, :, before : before + W] = planes
    for ends in (slice(before), slice(before + W, None)):
        whole[:, :, ends] = planes[:, :, columns[ends]]
    return whole
