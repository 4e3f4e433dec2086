"""`radiance.merge` by look-up tables: blocks of rows, several threads, a quarter of the memory.

Z       pixel levels      (P, rows, W, C), frames from short to long, n = 256 or 65536 of them
T       table of a frame  (n,) complex64, a + i b: the terms of its radiance at each level
planes                    (K, C, rows, W) uint16: one frame, or two of 8 bits, for each channel
shown                     (P, rows, W) bool, or None where the frames show every pixel
E       radiance          (rows, W, C) float32

Every method is a quotient of two sums over the frames, sum_j a_j(Z_j) / sum_j b_j(Z_j). Each pixel
needs one look-up in each frame, because a and b are the real and the imaginary part of one number.
Two frames of 8 bits need one look-up together. In a large bracket, whose tables would need much more
memory than its frames, all frames have one table, and each scales what it finds there.
"""

import ctypes
import mmap
from collections.abc import Callable
from dataclasses import dataclass
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
# Frames of larger brackets have no tables of their own, which would need more memory than the
# frames: half a megabyte per channel for a pair, or for a frame of 16 bits.
MAX_TABLES = 32
# Frames of a block that become planes at a time; an even number, so that no pair is divided.
FRAMES_PER_GROUP = 32
# rows whose memory is given back at a time
RELEASED_ROWS = 256
# of a large page of memory
PAGE_BYTES = 2**21
# Pixels that no frame measures, times frames, whose bounds are found at a time.
MAX_UNMEASURED_LEVELS = 2**20


class _Factors(NamedTuple):
    """The factors of a frame of t seconds: a = exposure e + weight w, and b = total w.

    e is w g for "log" and w exp(g) for the other methods.
    """

    exposure: float
    weight: float
    total: float


FACTORS: dict[str, Callable[[float], _Factors]] = {
    "log": lambda t: _Factors(1, -float(np.log(t)), 1),
    "likelihood": lambda t: _Factors(t, 0, t**2),
    "mean": lambda t: _Factors(1 / t, 0, 1),
    "shot": lambda t: _Factors(1, 0, t),
}


@dataclass(frozen=True, kw_only=True, eq=False)
class _Plan:
    """The tables of the frames, from short to long, which are the same for all pixels.

    Attributes
    ----------
    B : (P,) ln times
    g : (n, C)
    top : the first level that is clipped
    factors : of each frame
    base : (C, n) complex64, e + i w of each channel, which times the factors is T of a frame
    is_paired : whether two frames of 8 bits share a plane
    plane_tables : (C, n * n) or (C, n), one table for each of the planes; empty for a large bracket
    finish : from the quotient to E
    """

    B: F64
    g: F64
    top: int
    factors: list[_Factors]
    base: Array
    is_paired: bool
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
    n = len(g)
    z = np.arange(n)
    is_measured = (z > 0) & (z < top)
    level_weights = np.where(is_measured, np.maximum(w, MIN_RELATIVE_WEIGHT * w.max()), 0.0)
    exposures = g if method == "log" else np.exp(g)
    base = (level_weights[:, None] * (exposures + 1j)).T
    factors = [FACTORS[method](float(t)) for t in times]
    plane_tables: list[Array] = []
    is_paired = False
    if len(times) <= MAX_TABLES:
        tables = np.stack([_scale(base, frame).astype(np.complex64) for frame in factors])
        is_paired = n == 256
        plane_tables = _pair_tables(tables) if is_paired else list(tables)
    return _Plan(
        B=np.log(times),
        g=g,
        top=top,
        factors=factors,
        base=base.astype(np.complex64),
        is_paired=is_paired,
        plane_tables=plane_tables,
        finish=np.exp if method == "log" else np.positive,
    )


def _scale(terms: Array, factors: _Factors) -> Array:
    """Return a + i b of a frame, from e + i w."""
    a = factors.exposure * terms.real + factors.weight * terms.imag
    return np.asarray(a + 1j * factors.total * terms.imag)


def _pair_tables(tables: Array) -> list[Array]:
    """Return one table for each two frames of 8 bits: T1(z1) + T2(z2) at z1 + 256 z2.

    The last one of an odd number keeps its own.
    """
    count, channel_count, n = tables.shape
    firsts = tables[0 : count - 1 : 2, :, None, :]
    seconds = tables[1::2, :, :, None]
    pairs = (seconds + firsts).reshape(-1, channel_count, n * n)
    unpaired = tables[count - count % 2 :]
    return [*pairs, *unpaired]


def _planes(frames: list[Array], is_paired: bool) -> Array:
    """Return the frames' rows (rows, W, C) as planes (K, C, rows, W), each of one channel.

    Two paired frames make one plane, z1 + 256 z2: it has half as many elements to copy, and is the
    index into the table of the pair.
    """
    rows, width, channel_count = frames[0].shape
    frames_per_plane = 2 if is_paired else 1
    plane_count = -(-len(frames) // frames_per_plane)
    planes = np.empty((plane_count, channel_count, rows, width), np.uint16)
    for plane, j in zip(planes, range(0, len(frames), frames_per_plane), strict=True):
        levels = frames[j]
        if frames_per_plane == 2 and j + 1 < len(frames):
            levels = np.multiply(frames[j + 1], 256, dtype=np.uint16) + levels
        plane[:] = levels.transpose(2, 0, 1)
    return planes


def _drop_clipped(planes: Array, is_paired: bool, top: int) -> Array:
    """Return the planes with level 0, which has no weight, where a frame clips any channel."""
    # each element is a level: (K, C, rows, 2 W) for pairs of frames
    Z = planes.view(np.uint8 if is_paired else np.uint16)
    is_unclipped = Z.max(axis=1, keepdims=True) < top
    return np.multiply(Z, is_unclipped.view(np.uint8), out=Z).view(np.uint16)


def _sums_by_base(planes: Array, base: Array, factors: list[_Factors]) -> Array:
    """Return what `_sums` returns, from one table for all frames."""
    total = np.zeros(planes.shape[1:], np.complex64)
    for index, frame in zip(planes, factors, strict=True):
        total += _scale(base.take(index, mode="clip"), frame)
    return total


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
    totals = _sum_channels(frames, shown, plan)
    quality[:] = Quality.MEASURED
    for c, total in enumerate(totals):
        with np.errstate(divide="ignore", invalid="ignore"):
            mean = total.real / total.imag
        E[..., c] = plan.finish(mean)
        if np.isnan(mean).any():  # 0 / 0
            rows, columns = np.nonzero(np.isnan(mean))
            step = max(1, MAX_UNMEASURED_LEVELS // len(frames))
            for start in range(0, len(rows), step):
                y = rows[start : start + step]
                x = columns[start : start + step]
                Z = np.stack([frame[y, x, c] for frame in frames])
                is_shown = np.ones(Z.shape, bool) if shown is None else shown[:, y, x]
                E[y, x, c], flags = _estimate_unmeasured(Z, is_shown, c, plan)
                quality[y, x] |= flags


def _sum_channels(frames: list[Array], shown: Mask | None, plan: _Plan) -> Array:
    """Return the sums over all frames, (C, rows, W), a group of frames at a time."""
    totals = np.zeros((plan.g.shape[1], *frames[0].shape[:2]), np.complex64)
    for start in range(0, len(frames), FRAMES_PER_GROUP):
        group = frames[start : start + FRAMES_PER_GROUP]
        if shown is not None:
            masks = shown[start : start + FRAMES_PER_GROUP]
            group = [frame * mask[..., None] for frame, mask in zip(group, masks, strict=True)]
        planes = _drop_clipped(_planes(group, plan.is_paired), plan.is_paired, plan.top)
        for c in range(plan.g.shape[1]):
            if plan.plane_tables:
                tables = [table[c] for table in plan.plane_tables]
                totals[c] += _sums(planes[:, c], tables)
            else:
                factors = plan.factors[start : start + FRAMES_PER_GROUP]
                totals[c] += _sums_by_base(planes[:, c], plan.base[c], factors)
    return totals


def _estimate_unmeasured(Z: Array, shown: Mask, c: int, plan: _Plan) -> tuple[F64, Flags]:
    """Return E (M,) and flags (M,) of pixels where every frame clips a channel, or is black in c.

    Frames that measure channel c itself are used; where there is none, E is a bound.
    """
    E, flags = bound(Z, plan.B, plan.g[:, c], plan.top, shown)
    sums = np.zeros(Z.shape[1], np.complex64)
    for frame, levels in zip(plan.factors, Z * shown, strict=True):
        sums += _scale(plan.base[c][levels], frame)
    is_measured = sums.imag > 0
    E[is_measured] = plan.finish(sums[is_measured].real / sums[is_measured].imag)
    flags[is_measured] = Quality.MEASURED
    return E, flags
