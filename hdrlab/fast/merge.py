"""`radiance.merge` by look-up tables: blocks of rows, several threads, a quarter of the memory.

Z       pixel levels      (P, rows, W, C), frames from short to long, n = 256 or 65536 of them
T       table of a frame  (n,) complex64, a + i b: the terms of its radiance at each level
planes                    (K, C, rows, W) uint16: of each channel, one frame or two of 8 bits together
shown                     (P, rows, W) bool, or None where the frames show every pixel
E       radiance          (rows, W, C) float32

Every method is a quotient of two sums over the frames, sum_j a_j(Z_j) / sum_j b_j(Z_j). A pixel
costs one look-up a frame, a as the real and b as the imaginary part of one number, and two frames
of 8 bits cost one together.
"""

import ctypes
import mmap
from collections.abc import Callable
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from hdrlab.core.arrays import F32, F64, Array, ArrayLike, Flags, Mask, as_mask
from hdrlab.core.bracket import short_to_long
from hdrlab.core.threads import map_in_threads
from hdrlab.radiance.merge import (
    CLIPPING_LEVEL,
    MIN_RELATIVE_WEIGHT,
    Merged,
    Quality,
    as_tables,
    bound,
)
from hdrlab.radiance.stuck import repair_stuck

# as many rows as have planes and sums that stay in the processor's cache
BLOCK_ROWS = 24
# rows whose memory is given back at a time
RELEASED_ROWS = 256
# of a large page of memory
PAGE_BYTES = 2**21
# the terms a, b of one frame of t seconds, from w and g over the levels
TERMS: dict[str, Callable[[F64, F64, float], tuple[F64, F64]]] = {
    "log": lambda w, g, t: (w * (g - np.log(t)), w),
    "likelihood": lambda w, g, t: (w * np.exp(g) * t, w * t**2),
    "mean": lambda w, g, t: (w * np.exp(g) / t, w),
    "shot": lambda w, g, t: (w * np.exp(g), w * t),
}


class _Plan(NamedTuple):
    """What the frames, from short to long, measure at every level: the same for all pixels."""

    B: F64  # (P,) ln times
    g: F64  # (n, C)
    top: int  # the first level that is clipped
    tables: Array  # (P, C, n), T of each frame and channel
    pairs: list[Array]  # (C, n * n) or (C, n), one table for each of the planes
    finish: Callable[[Array], Array]  # from the quotient to E


class Expendable(np.ndarray[Any, np.dtype[Any]]):
    """Photographs that are lost when they are merged: their memory goes back to the system, band by band."""


def merge(images: ArrayLike, times: ArrayLike, g: ArrayLike, w: ArrayLike | None = None) -> F32:
    """Return the radiance map, the lesson's."""
    return merge_with_quality(images, times, g, w, repair=False).E


def merge_with_quality(
    images: ArrayLike,
    times: ArrayLike,
    g: ArrayLike,
    w: ArrayLike | None = None,
    *,
    method: str = "log",
    top: float = CLIPPING_LEVEL,
    repair: bool = True,
    valid: ArrayLike | None = None,
) -> Merged:
    """Return the radiance map and the quality flags of its pixels, the lesson's."""
    stack, t, w, g, first = as_tables(images, times, g, w, method, top)
    mask = as_mask(valid, stack)
    order = short_to_long(stack, t)
    plan = _plan(t[order], g, w, first, method)
    pixels = stack.reshape(*stack.shape[:3], -1)
    E = np.empty(pixels.shape[1:], np.float32)
    quality = np.empty(pixels.shape[1:3], np.uint8)

    def merge_rows(start: int) -> None:
        rows = slice(start, start + BLOCK_ROWS)
        shown = None if mask is None else np.stack([mask[j, rows] for j in order])
        _merge_block([pixels[j, rows] for j in order], shown, plan, E[rows], quality[rows])

    starts = range(0, len(quality), BLOCK_ROWS)
    for start, _ in zip(starts, map_in_threads(merge_rows, starts), strict=True):
        if isinstance(images, Expendable) and start % RELEASED_ROWS == 0:
            for j in order[1:-1]:  # the shortest and the longest tell what is stuck
                _release(stack[j, :start])
    plan.pairs.clear()  # the tables are needed no more
    if repair:
        quality[repair_stuck(E, stack, t, mask)] = Quality.STUCK
    return Merged(E.reshape(stack.shape[1:]), quality)


def _release(rows: Array) -> None:
    """Give the memory of rows that lie together back, in whole pages: Linux fills them with 0 when read."""
    start = -(-rows.ctypes.data // PAGE_BYTES) * PAGE_BYTES
    stop = (rows.ctypes.data + rows.nbytes) // PAGE_BYTES * PAGE_BYTES
    if hasattr(mmap, "MADV_DONTNEED") and rows.flags.c_contiguous and stop > start:
        ctypes.CDLL(None).madvise(
            ctypes.c_void_p(start), ctypes.c_size_t(stop - start), mmap.MADV_DONTNEED
        )


def _plan(times: F64, g: F64, w: F64, top: int, method: str) -> _Plan:
    """Return the _Plan of frames with these times."""
    n, channels = g.shape
    z = np.arange(n)
    usable = np.where((z > 0) & (z < top), np.maximum(w, MIN_RELATIVE_WEIGHT * w.max()), 0.0)
    tables = np.empty((len(times), channels, n), np.complex64)
    for (j, t), c in product(enumerate(times), range(channels)):
        a, b = TERMS[method](usable, g[:, c], t)
        tables[j, c] = a + 1j * b
    finish = np.exp if method == "log" else np.positive
    return _Plan(np.log(times), g, top, tables, _pair_tables(tables), finish)


def _pair_tables(tables: Array) -> list[Array]:
    """Return the tables of two 8-bit frames as one: at z1 + 256 z2 stands T1(z1) + T2(z2)."""
    count, channels, n = tables.shape
    if n > 256:
        return list(tables)
    firsts = tables[0 : count - 1 : 2, :, None, :]
    seconds = tables[1::2, :, :, None]
    return [*(seconds + firsts).reshape(-1, channels, n * n), *tables[count - count % 2 :]]


def _planes(frames: list[Array]) -> Array:
    """Return the frames' rows (rows, W, C) as planes (K, C, rows, W): colour never in an inner loop.

    Two 8-bit frames make one plane, z1 + 256 z2: half as many elements to copy, and the index into
    the pair's table.
    """
    paired = frames[0].dtype == np.uint8
    rows, width, channels = frames[0].shape
    planes = np.empty(
        (-(-len(frames) // 2) if paired else len(frames), channels, rows, width), np.uint16
    )
    for k, plane in enumerate(planes):
        first, *second = frames[2 * k : 2 * k + 2] if paired else frames[k : k + 1]
        both = np.multiply(second[0], 256, dtype=np.uint16) + first if second else first
        plane[:] = both.transpose(2, 0, 1)
    return planes


def _drop_clipped(planes: Array, n: int, top: int) -> Array:
    """Return the planes with level 0, which weighs nothing, in all channels where a frame clips one."""
    Z = planes.view(
        np.uint8 if n == 256 else np.uint16
    )  # each element a level: of pairs, (K, C, rows, 2 W)
    whole = Z.max(axis=1, keepdims=True) < top
    return np.multiply(Z, whole.view(np.uint8), out=Z).view(np.uint16)


def _sums(planes: Array, tables: list[Array]) -> Array:
    """Return sum_j a_j(Z_j) + i sum_j b_j(Z_j) of one channel, (rows, W), from its planes (K, rows, W)."""
    total = tables[0].take(
        planes[0], mode="clip"
    )  # "clip" only spares the check: no level lies outside
    term = np.empty_like(total)
    for index, table in zip(planes[1:], tables[1:], strict=True):
        table.take(index, out=term, mode="clip")
        total += term
    return total


def _merge_block(
    frames: list[Array], shown: Mask | None, plan: _Plan, E: Array, quality: Flags
) -> None:
    """Fill a block of rows, E (rows, W, C) and quality (rows, W), from the frames' rows (rows, W, C)."""
    masked = frames
    if shown is not None:
        masked = [frame * one[..., None] for frame, one in zip(frames, shown, strict=True)]
    planes = _drop_clipped(_planes(masked), len(plan.g), plan.top)
    quality[:] = Quality.MEASURED
    for c in range(plan.g.shape[1]):
        total = _sums(planes[:, c], [table[c] for table in plan.pairs])
        with np.errstate(divide="ignore", invalid="ignore"):
            mean = total.real / total.imag
        E[..., c] = plan.finish(mean)
        if np.isnan(mean).any():  # 0 / 0
            y, x = np.nonzero(np.isnan(mean))
            Z = np.stack([frame[y, x, c] for frame in frames])
            E[y, x, c], flags = _unmeasured(Z, Z >= 0 if shown is None else shown[:, y, x], c, plan)
            quality[y, x] |= flags


def _unmeasured(Z: Array, shown: Mask, c: int, plan: _Plan) -> tuple[F64, Flags]:
    """Return E (M,) and flags (M,): frames with another clipped channel measure it, or else bounds."""
    E, flags = bound(Z, plan.B, plan.g[:, c], plan.top, shown)
    alone = sum(table[c][levels] for table, levels in zip(plan.tables, Z * shown, strict=True))
    measured = alone.imag > 0
    E[measured] = plan.finish(alone[measured].real / alone[measured].imag)
    flags[measured] = Quality.MEASURED
    return E, flags
