"""Exposure fusion with pyramids by matrix products, and measures in bands of rows."""

from collections.abc import Iterator, Sequence

import numpy as np

from hdrlab.core.arrays import F32, Array, levels
from hdrlab.enhance import mertens
from hdrlab.fast import _bands, pyramid, with_parts

_BAND_ROWS = 16


def _split_planes(Z: Array) -> F32:
    """Return F = Z / top level, the channels as planes, each in one piece."""
    planes = np.ascontiguousarray(np.moveaxis(np.atleast_3d(Z), -1, 0))
    return planes * np.float32(1 / (levels(Z) - 1))


def weights(images: Array, powers: Sequence[float] = (1, 1, 1)) -> Iterator[F32]:
    """Yield W_j / sum_i W_i of each photograph: they sum to 1 in every pixel [Mertens07]."""

    def measure(Z: Array) -> F32:
        return mertens.weight(_split_planes(np.moveaxis(Z, 0, -1)), powers)

    image_weights: list[F32] = [
        _bands.banded(measure, np.moveaxis(np.atleast_3d(Z), -1, 0), margin=1) for Z in images
    ]
    total: F32 = np.zeros(images.shape[1:3], np.float32)
    for W in image_weights:
        total += W
    while image_weights:  # pop, so that the memory of each is freed once it was used
        yield image_weights.pop(0) / total


def add_term(blended: F32, W: F32, detail: F32) -> F32:
    """Return the sum of W_i,k L_i,k so far and the next W_j,k L_j,k [Mertens07]."""
    total = np.empty_like(blended)
    for top in range(0, len(W), _BAND_ROWS):
        rows = slice(top, top + _BAND_ROWS)
        band = np.multiply(W[rows], detail[:, rows], out=total[:, rows])
        band += blended[:, rows]
    return total


_parts = {
    "weights": weights,
    "add_term": add_term,
    "pyramid": pyramid,
    "split_planes": _split_planes,
}
fuse_steps = with_parts(__name__, mertens.fuse_steps, **_parts)
fuse = with_parts(__name__, mertens.fuse, fuse_steps=fuse_steps, pyramid=pyramid)
