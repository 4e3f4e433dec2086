"""Image pyramids (Burt and Adelson, IEEE Transactions on Communications 31(4), 1983).

image  (..., H, W) float32; colour lies in planes, (3, H, W)
w      taps of the kernel, (1 4 6 4 1) / 16 along either axis
g_k    level k of the Gaussian pyramid, (..., ceil(H / 2^k), ceil(W / 2^k)); g_0 is the image
L_k    level k of the Laplacian pyramid: what g_k holds beyond the enlarged g_(k+1)
K      band matrix, the rows of which hold the taps: a tile of rows is K times the rows they look at

Pixel i of a level lies over pixel 2 i of the next finer one. Beyond its ends a level goes on by reflection
about its first and last pixels; only where `enlarged` looks past the last, that one is repeated.
"""

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike, NDArray

from hdrlab.core import blur
from hdrlab.core.arrays import describe

Float = NDArray[np.float32]

TILE = 16  # coarse rows of a product, as in `blur`
BURT = (1, 6, 1)  # eighths: an even fine pixel from the coarse ones before, over and after it
LINEAR = (0, 8, 0)  # eighths: an even fine pixel is the coarse one over it


def reduced(image: ArrayLike) -> Float:
    """Return g_(k+1)(i) = sum_m w(m) g_k(2 i + m), m = -2 ... 2, along both axes [Burt83 eq. 1].

    Sides are halved, and rounded up where they are odd.
    """
    image = _as_image(image)
    K = blur.band(np.array([1, 4, 6, 4, 1]) / 16, TILE, 2)
    padded = _padded(image, [(2, -n % (2 * TILE) + 1) for n in image.shape[-2:]], "reflect")
    rows, columns = half(image.shape)
    return _product(K, 2 * TILE, padded)[..., :rows, :columns]


def enlarged(image: ArrayLike, shape: Sequence[int], *, taps: Sequence[float] = BURT) -> Float:
    """Return 2 sum_m w(m) g_k((i - m) / 2), only whole (i - m) / 2 counted, along both axes [Burt83 eq. 2].

    Along an axis an even pixel is (1 6 1) / 8 of three coarse ones, an odd one the mean of two; with the
    `taps` LINEAR it is linear interpolation. The last two of `shape` are the finer level's sides.
    """
    image = _as_image(image)
    if image.shape[-2:] != half(shape):
        raise ValueError(f"expected sides {half(shape)}, half of {tuple(shape[-2:])}, got {describe(image)}")
    begun = _padded(image, [(1, 0), (1, 0)], "reflect")
    ended = _padded(begun, [(0, -n % TILE + 1) for n in image.shape[-2:]], "edge")
    return _product(_interpolation(taps), TILE, ended)[..., : shape[-2], : shape[-1]]


def gaussian(image: ArrayLike, levels: int) -> list[Float]:
    """Return g_0, g_1, ...: `levels` of them, each the one before it `reduced`."""
    pyramid = [_as_image(image)]
    while len(pyramid) < levels:
        pyramid.append(reduced(pyramid[-1]))
    return pyramid


def laplacian(image: ArrayLike, levels: int) -> list[Float]:
    """Return L_k = g_k - enlarged(g_(k+1)), and last the coarsest g itself [Burt83 eq. 3]."""
    g = gaussian(image, levels)
    return [fine - enlarged(coarse, fine.shape) for fine, coarse in zip(g, g[1:], strict=False)] + g[-1:]


def collapsed(pyramid: Sequence[Float]) -> Float:
    """Return g_0 by g_k = L_k + enlarged(g_(k+1)), coarse to fine: `laplacian` undone [Burt83 eq. 4]."""
    image = pyramid[-1]
    for detail in reversed(pyramid[:-1]):
        image = detail + enlarged(image, detail.shape)
    return image


def depth(shape: Sequence[int], smallest: int) -> int:
    """Return the number of levels until another would have a side below `smallest` pixels, at least 1."""
    side, levels = min(shape[-2:]), 1
    while side > 1 and (side + 1) // 2 >= smallest:
        side, levels = (side + 1) // 2, levels + 1
    return levels


def _product(K: Float, step: int, image: Float) -> Float:
    """Return K image K^T in tiles: rows, then columns, a window every `step` pixels."""
    tile, reach = K.shape
    windows = sliding_window_view(image, reach, axis=-2)[..., ::step, :, :].swapaxes(-1, -2)
    tall = np.matmul(K, windows).reshape(*image.shape[:-2], -1, image.shape[-1])
    windows = sliding_window_view(tall, reach, axis=-1)[..., ::step, :]  # (..., H, tiles, reach)
    product = np.empty((*windows.shape[:-1], tile), np.float32)
    # in place, from a K^T that lies in one piece: such products go to BLAS, others take five times as long
    np.matmul(windows.swapaxes(-2, -3), np.ascontiguousarray(K.T), out=product.swapaxes(-2, -3))
    return product.reshape(*tall.shape[:-1], -1)


def _interpolation(taps: Sequence[float]) -> Float:
    """Return K (2 TILE, TILE + 2): `taps`, and half and half, in turn."""
    K = np.zeros((2 * TILE, TILE + 2), np.float32)
    for i in range(TILE):
        K[2 * i, i : i + 3] = np.divide(taps, 8)
        K[2 * i + 1, i + 1 : i + 3] = 0.5
    return K


def _padded(image: Float, ends: list[tuple[int, int]], mode: Literal["reflect", "edge"]) -> Float:
    """Return the image with its sides continued, before and after."""
    return np.pad(image, [(0, 0)] * (image.ndim - 2) + ends, mode=mode)


def half(shape: Sequence[int]) -> tuple[int, int]:
    """Return the sides of the next coarser level."""
    return (shape[-2] + 1) // 2, (shape[-1] + 1) // 2


def _as_image(image: ArrayLike) -> Float:
    array = np.asarray(image, np.float32)
    if array.ndim < 2 or 0 in array.shape:
        raise ValueError(f"expected an image (..., H, W), got {describe(array)}")
    return array
