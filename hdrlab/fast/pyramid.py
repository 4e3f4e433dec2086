"""Fast image pyramids: sums of whole rows, band by band; see `core.filters.pyramid`."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Literal

import numpy as np

from hdrlab.core.arrays import F32
from hdrlab.core.filters import pyramid
from hdrlab.core.filters.pyramid import depth, half_shape  # noqa: F401
from hdrlab.fast import with_parts

# as many coarse pixels as stay in the processor's cache
_PIXELS_PER_BAND = 2**14
_MIN_ROWS_PER_BAND = 8


def reduce(image: F32) -> F32:
    """Return g_(k+1)(i) = sum_m w(m) g_k(2 i + m), m = -2 ... 2, along both axes [Burt83 eq. 1]."""
    h, w = half_shape(image.shape)
    planes = np.pad(image.reshape(-1, *image.shape[-2:]), ((0, 0), (2, 2), (2, 2)), "reflect")
    g = np.empty((len(planes), h, w), np.float32)
    for c, top, stop in _bands(g):
        band = planes[c, 2 * top : 2 * stop + 3, : 2 * w + 3]
        half_height = _halve_rows(band)
        g[c, top:stop] = _halve_rows(half_height.T).T
    return g.reshape(*image.shape[:-2], h, w)


def _bands(planes: F32) -> list[tuple[int, int, int]]:
    """Return the bands of all planes: the number of the plane, its first row, and the row after."""
    count, h, w = planes.shape
    rows = max(_MIN_ROWS_PER_BAND, _PIXELS_PER_BAND // w)
    return [(c, top, min(top + rows, h)) for c in range(count) for top in range(0, h, rows)]


def _halve_rows(a: F32) -> F32:
    """Return every second row of a, blurred by the weights (1, 4, 6, 4, 1) / 16."""
    outer = a[:-4:2] + a[4::2]
    inner = a[1:-3:2] + a[3:-1:2]
    return (outer + 4 * inner + 6 * a[2:-2:2]) * np.float32(1 / 16)


def interpolate(image: F32, shape: Sequence[int]) -> F32:
    """Return `image` (H, W) at the next finer level, of this shape, by linear interpolation."""
    fine = np.empty(shape, np.float32)
    for _, rows, values in _expand_bands(image, shape, neighbour_weight=0):
        fine[rows] = values
    return fine


gaussian = with_parts(__name__, pyramid.gaussian, reduce=reduce)


def laplacian(image: F32, levels: int) -> list[F32]:
    """Return L_k = g_k - expand(g_(k+1)), and last the coarsest g itself [Burt83 eq. 3]."""
    g = gaussian(image, levels)
    details = [_combine(np.subtract, fine, coarse) for fine, coarse in pairwise(g)]
    return [*details, g[-1]]


def collapse(pyramid: Sequence[F32]) -> F32:
    """Return g_0 by g_k = L_k + expand(g_(k+1)), the inverse of `laplacian` [Burt83 eq. 4]."""
    image = pyramid[-1]
    for detail in reversed(pyramid[:-1]):
        image = _combine(np.add, detail, image)
    return image


def _combine(operation: np.ufunc, fine: F32, coarse: F32) -> F32:
    """Return operation(fine, expand(coarse)), band by band."""
    planes = fine.reshape(-1, *fine.shape[-2:])
    result = np.empty(planes.shape, np.float32)
    for c, rows, values in _expand_bands(coarse, fine.shape):
        operation(planes[c, rows], values, out=result[c, rows])
    return result.reshape(fine.shape)


def _expand_bands(
    coarse: F32, shape: Sequence[int], neighbour_weight: float = 1 / 8
) -> Iterator[tuple[int, slice, F32]]:
    """Yield the next finer level, of this shape, in bands: the plane, the rows and their values.

    neighbour_weight : of both neighbours in the rows (and columns) that the levels have in common
    """
    planes = coarse.reshape(-1, *coarse.shape[-2:])
    padded = np.pad(planes, ((0, 0), (1, 0), (1, 0)), "reflect")
    padded = np.pad(padded, ((0, 0), (0, 1), (0, 1)), "edge")
    for c, top, stop in _bands(planes):
        rows = slice(2 * top, min(2 * stop, shape[-2]))
        tall = _double_rows(padded[c, top : stop + 2], neighbour_weight)
        large = _double_rows(tall.T, neighbour_weight, "F").T
        yield c, rows, large[: rows.stop - rows.start, : shape[-1]]


def _double_rows(a: F32, neighbour_weight: float, order: Literal["C", "F"] = "C") -> F32:
    """Return two rows for each inner row: the row with its neighbours, and its mean with the next."""
    fine = np.empty((2 * len(a) - 4, a.shape[1]), np.float32, order)
    sums = a[:-1] + a[1:]
    np.multiply(sums[1:], np.float32(0.5), out=fine[1::2])
    # the two sums beside a row contain the row twice
    even = a[1:-1] * np.float32(1 - 4 * neighbour_weight)
    if neighbour_weight:
        even += (sums[:-1] + sums[1:]) * np.float32(neighbour_weight)
    fine[::2] = even
    return fine
