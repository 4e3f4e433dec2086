"""`radiance.merge` by look-up tables: blocks of rows, several threads, a quarter of the memory.

Z       pixel levels      (P, rows, W, C), frames from short to long, n = 256 or 65536 of them
T       table of a frame  (n,) complex64, a + i b: the terms of its radiance at each level
planes                    (K, C, rows, W) uint16: one frame, or two of 8 bits, for each channel
shown                     (P, rows, W) bool, or None where the frames show every pixel
E       radiance          (rows, W, C) float32

Every method is a quotient of two sums over the frames, sum_j a_j(Z_j) / sum_j b_j(Z_j). Each pixel
needs one look-up in each frame, because a and b are the real and the imaginary part of one number.
Two frames of 8 bits need one look-up together.
"""

import ctypes
import mmap
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

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


@dataclass(frozen=True, kw_only=True, eq=False)
class _Plan:
    """The tables of the frames, from short to long, which are the same for all pixels.

    Attributes
    ----------
    B : (P,) ln times
    g : (n, C)
    top : the first level that is clipped
    tables : (P, C, n), T of each frame and channel
    plane_tables : (C, n * n) or (C, n), one table for each of the planes
    finish : from the quotient to E
    """

    B: F64
    g: F64
    top: int
    tables: Array
    plane_tables: list[Array]
    finish: Callable[[Array], Array]


class Expendable(np.ndarray[Any, np.dtype[Any]]):
    """Photos whose memory the merge gives back to the system, band by band; they are lost."""


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
    stack, t, w, g, first_clipped = as_tables(images, times, g, w, method, top)
    mask = as_mask(valid, stack)
    order = short_to_long(stack, t)
    plan = _make_plan(t[order], g, w, first_clipped, method)
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
            # not the shortest and the longest frame, which show the stuck pixels
            for j in order[1:-1]:
                _release(stack[j, :start])
    plan.plane_tables.clear()  # frees their memory
    if repair:
        quality[repair_stuck(E, stack, t, mask)] = Quality.STUCK
    return Merged(E.reshape(stack.shape[1:]), quality)


def _release(rows: Array) -> None:
    """Give the memory of contiguous rows back in whole pages, which Linux then reads as 0."""
    start = -(-rows.ctypes.data // PAGE_BYTES) * PAGE_BYTES
    stop = (rows.ctypes.data + rows.nbytes) // PAGE_BYTES * PAGE_BYTES
    if hasattr(mmap, "MADV_DONTNEED") and rows.flags.c_contiguous and stop > start:
        ctypes.CDLL(None).madvise(
            ctypes.c_void_p(start), ctypes.c_size_t(stop - start), mmap.MADV_DONTNEED
        )


def _make_plan(times: F64, g: F64, w: F64, top: int, method: str) -> _Plan:
    """Return the _Plan of frames with these times."""
    n, channel_count = g.shape
    z = np.arange(n)
    is_measured = (z > 0) & (z < top)
    level_weights = np.where(is_measured, np.maximum(w, MIN_RELATIVE_WEIGHT * w.max()), 0.0)
    tables = np.empty((len(times), channel_count, n), np.complex64)
    for j, t in enumerate(times):
        for c in range(channel_count):
            a, b = TERMS[method](level_weights, g[:, c], t)
            tables[j, c] = a + 1j * b
    return _Plan(
        B=np.log(times),
        g=g,
        top=top,
        tables=tables,
        plane_tables=_pair_tables(tables),
        finish=np.exp if method == "log" else np.positive,
    )


def _pair_tables(tables: Array) -> list[Array]:
    """Return one table for each two frames of 8 bits: T1(z1) + T2(z2) at z1 + 256 z2.

    Frames of 16 bits, and the last one of an odd number, keep their own.
    """
    count, channel_count, n = tables.shape
    if n > 256:
        return list(tables)
    firsts = tables[0 : count - 1 : 2, :, None, :]
    seconds = tables[1::2, :, :, None]
    pairs = (seconds + firsts).reshape(-1, channel_count, n * n)
    unpaired = tables[count - count % 2 :]
    return [*pairs, *unpaired]


def _planes(frames: list[Array]) -> Array:
    """Return the frames' rows (rows, W, C) as planes (K, C, rows, W), each of one channel.

    Two 8-bit frames make one plane, z1 + 256 z2: it has half as many elements to copy, and is the
    index into the table of the pair.
    """
    rows, width, channel_count = frames[0].shape
    frames_per_plane = 2 if frames[0].dtype == np.uint8 else 1
    plane_count = -(-len(frames) // frames_per_plane)
    planes = np.empty((plane_count, channel_count, rows, width), np.uint16)
    for plane, j in zip(planes, range(0, len(frames), frames_per_plane), strict=True):
        levels = frames[j]
        if frames_per_plane == 2 and j + 1 < len(frames):
            levels = np.multiply(frames[j + 1], 256, dtype=np.uint16) + levels
        plane[:] = levels.transpose(2, 0, 1)
    return planes


def _drop_clipped(planes: Array, n: int, top: int) -> Array:
    """Return the planes with level 0, which has no weight, where a frame clips any channel."""
    # each element is a level: (K, C, rows, 2 W) for pairs of frames
    Z = planes.view(np.uint8 if n == 256 else np.uint16)
    is_unclipped = Z.max(axis=1, keepdims=True) < top
    return np.multiply(Z, is_unclipped.view(np.uint8), out=Z).view(np.uint16)


def _sums(planes: Array, tables: list[Array]) -> Array:
    """Return sum_j a_j(Z_j) + i sum_j b_j(Z_j), (rows, W), of a channel's planes (K, rows, W)."""
    # every level is in range; "clip" only saves the check
    total = tables[0].take(planes[0], mode="clip")
    term = np.empty_like(total)
    for index, table in zip(planes[1:], tables[1:], strict=True):
        table.take(index, out=term, mode="clip")
        total += term
    return total


def _merge_block(
    frames: list[Array], shown: Mask | None, plan: _Plan, E: Array, quality: Flags
) -> None:
    """Fill a block of rows of E (rows, W, C) and quality (rows, W) from the frames (rows, W, C)."""
    masked = frames
    if shown is not None:
        masked = [frame * mask[..., None] for frame, mask in zip(frames, shown, strict=True)]
    planes = _drop_clipped(_planes(masked), len(plan.g), plan.top)
    quality[:] = Quality.MEASURED
    for c in range(plan.g.shape[1]):
        total = _sums(planes[:, c], [table[c] for table in plan.plane_tables])
        with np.errstate(divide="ignore", invalid="ignore"):
            mean = total.real / total.imag
        E[..., c] = plan.finish(mean)
        if np.isnan(mean).any():  # 0 / 0
            y, x = np.nonzero(np.isnan(mean))
            Z = np.stack([frame[y, x, c] for frame in frames])
            is_shown = np.ones(Z.shape, bool) if shown is None else shown[:, y, x]
            E[y, x, c], flags = _estimate_unmeasured(Z, is_shown, c, plan)
            quality[y, x] |= flags


def _estimate_unmeasured(Z: Array, shown: Mask, c: int, plan: _Plan) -> tuple[F64, Flags]:
    """Return E (M,) and flags (M,) of pixels where every frame clips a channel, or is black in c.

    Frames that measure channel c itself are used; where there is none, E is a bound.
    """
    E, flags = bound(Z, plan.B, plan.g[:, c], plan.top, shown)
    sums = sum(table[c][levels] for table, levels in zip(plan.tables, Z * shown, strict=True))
    is_measured = sums.imag > 0
    E[is_measured] = plan.finish(sums[is_measured].real / sums[is_measured].imag)
    flags[is_measured] = Quality.MEASURED
    return E, flags
