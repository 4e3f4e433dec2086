"""Image pyramids (Burt and Adelson, IEEE Transactions on Communications 31(4), 1983).

image  (..., H, W) float32; colour lies in planes, (3, H, W)
w      taps of the kernel, (1 4 6 4 1) / 16 along either axis
g_k    level k of the Gaussian pyramid, (..., ceil(H / 2^k), ceil(W / 2^k)); g_0 is the image
L_k    level k of the Laplacian pyramid: what g_k holds beyond the enlarged g_(k+1)
K      band matrix, the rows of which hold the taps: a tile of rows is K times the rows they look at

Pixel i of a level lies over pixel 2 i of the next finer one. Beyond its ends a level goes on by reflection
about its first and last pixels; only where `enlarged` looks past the last, that one is repeated.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike, NDArray

from hdrlab.core.arrays import describe

Float = NDArray[np.float32]
Index = NDArray[np.intp]
Band = tuple[slice, Float]  # rows of a picture, and what stands in them

TILE = 8  # coarse rows and columns of a product: as many again would double its zeros
SLAB = 16  # tiles of rows at a time, which stay in the processor's cache
BURT = (1, 6, 1)  # eighths: an even fine pixel from the coarse ones before, over and after it
LINEAR = (0, 8, 0)  # eighths: an even fine pixel is the coarse one over it


def reduced(image: ArrayLike) -> Float:
    """Return g_(k+1)(i) = sum_m w(m) g_k(2 i + m), m = -2 ... 2, along both axes [Burt83 eq. 1].

    Sides are halved, and rounded up where they are odd.
    """
    image = _as_image(image)
    K = np.zeros((TILE, 2 * TILE + 3), np.float32)
    for i in range(TILE):
        K[i, 2 * i : 2 * i + 5] = np.array([1, 4, 6, 4, 1]) / 16
    rows, columns = (np.pad(np.arange(n), (2, -n % (2 * TILE) + 1), "reflect") for n in image.shape[-2:])
    g = np.empty((*image.shape[:-2], *half(image.shape)), np.float32)
    for band, found in _bands(K, 2 * TILE, image, rows, columns, g.shape):
        g[..., band, :] = found
    return g


def enlarged(image: ArrayLike, shape: Sequence[int], *, taps: Sequence[float] = BURT) -> Float:
    """Return 2 sum_m w(m) g_k((i - m) / 2), only whole (i - m) / 2 counted, along both axes [Burt83 eq. 2].

    Along an axis an even pixel is (1 6 1) / 8 of three coarse ones, an odd one the mean of two; with the
    `taps` LINEAR it is linear interpolation. The last two of `shape` are the finer level's sides.
    """
    image = _as_image(image)
    if image.shape[-2:] != half(shape):
        raise ValueError(f"expected sides {half(shape)}, half of {tuple(shape[-2:])}, got {describe(image)}")
    fine = np.empty((*image.shape[:-2], *shape[-2:]), np.float32)
    for band, found in _enlarged(image, shape, taps):
        fine[..., band, :] = found
    return fine


def _enlarged(image: Float, shape: Sequence[int], taps: Sequence[float] = BURT) -> Iterator[Band]:
    """Yield `enlarged` in bands: what is done with them at once is done in the processor's cache."""
    begun = (np.pad(np.arange(n), (1, 0), "reflect") for n in image.shape[-2:])
    rows, columns = (np.pad(i, (0, -(len(i) - 1) % TILE + 1), "edge") for i in begun)
    return _bands(_interpolation(taps), TILE, image, rows, columns, shape)


def gaussian(image: ArrayLike, levels: int) -> list[Float]:
    """Return g_0, g_1, ...: `levels` of them, each the one before it `reduced`."""
    pyramid = [_as_image(image)]
    while len(pyramid) < levels:
        pyramid.append(reduced(pyramid[-1]))
    return pyramid


def laplacian(image: ArrayLike, levels: int) -> list[Float]:
    """Return L_k = g_k - enlarged(g_(k+1)), and last the coarsest g itself [Burt83 eq. 3]."""
    pyramid = gaussian(image, levels)
    for k, (fine, coarse) in enumerate(pairwise(pyramid)):
        pyramid[k] = np.empty_like(fine)
        for band, found in _enlarged(coarse, fine.shape):
            np.subtract(fine[..., band, :], found, out=pyramid[k][..., band, :])
    return pyramid


def collapsed(pyramid: Sequence[Float]) -> Float:
    """Return g_0 by g_k = L_k + enlarged(g_(k+1)), coarse to fine: `laplacian` undone [Burt83 eq. 4].

    Examples
    --------
    >>> image = np.random.default_rng(0).random((5, 6), np.float32)
    >>> bool(np.allclose(collapsed(laplacian(image, 3)), image))
    True
    """
    image = pyramid[-1]
    for detail in reversed(pyramid[:-1]):
        coarse, image = image, np.empty_like(detail)
        for band, found in _enlarged(coarse, detail.shape):
            np.add(detail[..., band, :], found, out=image[..., band, :])
    return image


def depth(shape: Sequence[int], smallest: int) -> int:
    """Return the number of levels until another would have a side below `smallest` pixels, at least 1."""
    side, levels = min(shape[-2:]), 1
    while side > 1 and (side + 1) // 2 >= smallest:
        side, levels = (side + 1) // 2, levels + 1
    return levels


def _bands(
    K: Float, step: int, image: Float, rows: Index, columns: Index, shape: Sequence[int]
) -> Iterator[Band]:
    """Yield K image[rows, columns] K^T, cut to `shape`, as rows and what stands in them, from top to bottom.

    It is done in tiles, a window every `step` pixels along both axes, and a few tiles of rows at a time.
    """
    tile, reach = K.shape
    planes = image.reshape(-1, *image.shape[-2:])
    across = np.ascontiguousarray(K.T)  # in one piece, so that its products go to BLAS: five times as fast
    count = max(1, SLAB // len(planes))
    for top in range(0, shape[-2], count * tile):
        slab = planes[:, rows[top // tile * step :][: (count - 1) * step + reach]]
        windows = sliding_window_view(slab, reach, axis=1)[:, ::step].swapaxes(2, 3)  # (C, tiles, reach, W)
        tall = np.matmul(K, windows).reshape(len(planes), -1, slab.shape[2])
        windows = sliding_window_view(_continued(tall, columns), reach, axis=2)[:, :, ::step]
        wide = np.empty((*windows.shape[:3], tile), np.float32)  # (C, h, tiles, tile)
        np.matmul(windows.swapaxes(1, 2), across, out=wide.swapaxes(1, 2))
        band = slice(top, min(top + wide.shape[1], shape[-2]))
        found = wide.reshape(*image.shape[:-2], wide.shape[1], -1)
        yield band, found[..., : band.stop - top, : shape[-1]]


def _continued(planes: Float, columns: Index) -> Float:
    """Return planes[:, :, columns]: these are all columns in turn, with some before them and some after."""
    before, W = int(np.argmin(columns)), planes.shape[2]
    whole = np.empty((*planes.shape[:2], len(columns)), np.float32)
    whole[:, :, before : before + W] = planes
    for ends in (slice(before), slice(before + W, None)):
        whole[:, :, ends] = planes[:, :, columns[ends]]
    return whole


def _interpolation(taps: Sequence[float]) -> Float:
    """Return K (2 TILE, TILE + 2): `taps`, and half and half, in turn."""
    K = np.zeros((2 * TILE, TILE + 2), np.float32)
    for i in range(TILE):
        K[2 * i, i : i + 3] = np.divide(taps, 8)
        K[2 * i + 1, i + 1 : i + 3] = 0.5
    return K


def half(shape: Sequence[int]) -> tuple[int, int]:
    """Return the sides of the next coarser level."""
    return (shape[-2] + 1) // 2, (shape[-1] + 1) // 2


def _as_image(image: ArrayLike) -> Float:
    array = np.asarray(image, np.float32)
    if array.ndim < 2 or 0 in array.shape:
        raise ValueError(f"expected an image (..., H, W), got {describe(array)}")
    return array
