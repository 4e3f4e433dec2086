"""Exposure fusion with pyramids by matrix products, and measures in bands of rows."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike

from hdrlab.core.arrays import as_stack, levels
from hdrlab.core.steps import last
from hdrlab.core.types import F32, Array
from hdrlab.enhance import mertens
from hdrlab.fast import pyramid
from hdrlab.fast._bands import banded

_BAND = 16  # rows


def split_planes(Z: Array) -> F32:
    """Return F = Z / top level, the channels as planes."""
    channels = np.moveaxis(np.atleast_3d(Z), -1, 0)
    F = np.empty(channels.shape, np.float32)
    for plane, channel in zip(F, channels, strict=True):
        plane[:] = channel  # each in one piece, which is quicker than all together
    F /= np.float32(levels(Z) - 1)
    return F


def weights(images: Array, powers: Sequence[float] = (1, 1, 1)) -> Iterator[F32]:
    """Yield W_j / sum_i W_i, photograph after photograph: they sum to 1 in every pixel [Mertens07]."""

    def measure(Z: Array) -> F32:
        return mertens.weight(split_planes(np.moveaxis(Z, 0, -1)), powers)

    each = [banded(measure, np.moveaxis(np.atleast_3d(Z), -1, 0), margin=1) for Z in images]
    total = np.zeros(images.shape[1:3], np.float32)
    for W in each:
        total += W
    while each:  # what was yielded is freed
        yield each.pop(0) / total


def fuse_steps(
    images: ArrayLike | Sequence[ArrayLike],
    *,
    contrast: float = 1.0,
    saturation: float = 1.0,
    exposedness: float = 1.0,
) -> Iterator[mertens.State]:
    """Yield the State after each photograph; the parameters are those of `fuse`."""
    stack, powers = as_stack(images), (contrast, saturation, exposedness)
    if not all(0 <= power < np.inf for power in powers):
        raise ValueError(f"expected finite powers >= 0 of contrast, saturation and exposedness, got {powers}")
    depth = min(stack.shape[1:3]).bit_length()
    blended: list[F32] = []
    for j, W in enumerate(weights(stack, powers)):
        Wk, Lk = pyramid.gaussian(W, depth), pyramid.laplacian(split_planes(stack[j]), depth)
        blended = blended or [np.zeros_like(detail) for detail in Lk]
        blended = [_add(*level) for level in zip(blended, Wk, Lk, strict=True)]
        yield mertens.State(j, Wk, Lk, blended)


def _add(blended: F32, W: F32, detail: F32) -> F32:
    """Return blended + W detail at one level, in bands of rows, which stay in the processor's cache."""
    total = np.empty_like(blended)
    for top in range(0, len(W), _BAND):
        rows = slice(top, top + _BAND)
        band = np.multiply(W[rows], detail[:, rows], out=total[:, rows])
        band += blended[:, rows]
    return total


def fuse(
    images: ArrayLike | Sequence[ArrayLike],
    *,
    contrast: float = 1.0,
    saturation: float = 1.0,
    exposedness: float = 1.0,
) -> F32:
    """Return one picture that takes each place from the photographs that show it best."""
    steps = fuse_steps(images, contrast=contrast, saturation=saturation, exposedness=exposedness)
    R = pyramid.collapse(last(steps).blended)
    return R[0] if len(R) == 1 else np.moveaxis(R, 0, -1).copy()
