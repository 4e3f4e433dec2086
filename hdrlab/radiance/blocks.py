"""A block of rows, merged: the plan that holds for all pixels, and the look-ups that carry it out.

Z       pixel levels      (P, rows, W, C), frames from short to long, n = 256 or 65536 of them
T       table of a frame  (n,) complex64, a + i b: the terms of its estimate at each level
planes                    (K, C, rows, W) uint16: of each channel, one frame or two of 8 bits together
shown                     (P, rows, W) bool, or None where the frames show every pixel
E       radiance          (rows, W, C) float32

A pixel costs one look-up a frame, a as the real and b as the imaginary part of one number, and two frames of
8 bits cost one together. The sum is sum_j a_j(Z_j) + i sum_j b_j(Z_j), and E the quotient of its parts.
"""

from collections.abc import Callable
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core.arrays import Array, as_table, describe
from hdrlab.radiance.bounds import Seen, bound
from hdrlab.radiance.estimates import Terms, log_mean

Float = NDArray[np.float64]
FAINT = 1e-6  # weight of a measurement that should count for nothing: it does, unless there is no other


class Plan(NamedTuple):
    """What the frames, from short to long, say of every level: the same for all pixels."""

    B: Float  # (P,) ln times
    curves: Float  # (C, n), g of each channel
    top: int  # the first level that is clipped
    tables: Array  # (P, C, n), T of each frame and channel
    pairs: list[Array]  # (C, n * n) or (C, n), one table for each of the planes
    finish: Callable[[Array], Array]  # from the quotient to E


def plan(
    times: Float, g: ArrayLike, w: ArrayLike, terms: Terms, *, n: int, channels: int, top: float
) -> Plan:
    """Return the Plan of frames with these times, or raise a ValueError where the tables mean nothing."""
    if not 0 < top <= 1:
        raise ValueError(f"expected top as a fraction of the top level, 0 to 1, got {top}")
    first_clipped = min(int(top * (n - 1)) + 1, n - 1)
    curves, usable = _curves(g, n, channels), _usable(w, n, first_clipped)
    tables = np.empty((len(times), channels, n), np.complex64)
    for (j, t), (c, curve) in product(enumerate(times), enumerate(curves)):
        a, b = terms(usable, curve, t)
        tables[j, c] = a + 1j * b
    finish = np.exp if terms is log_mean else np.positive
    return Plan(np.log(times), curves, first_clipped, tables, pairs_of(tables), finish)


def _curves(g: ArrayLike, n: int, channels: int) -> Float:
    """Return g of each channel (C, n)."""
    table = as_table(g, n).reshape(n, -1)
    if table.shape[1] not in (1, channels):
        wanted = "(n,) for gray" if channels == 1 else "(n,) or (n, 3)"
        raise ValueError(f"expected a response {wanted}, got {describe(g)}")
    return np.broadcast_to(table, (n, channels)).T


def _usable(w: ArrayLike, n: int, first_clipped: int) -> Float:
    """Return the weights (n,) of the levels that measure something, and 0 at the others."""
    w = as_table(w, n)
    if w.ndim != 1 or not np.all(w >= 0) or not w.any():
        raise ValueError(f"expected weights (n,) that are not negative and not all 0, got {describe(w)}")
    z = np.arange(n)
    return np.where((z > 0) & (z < first_clipped), np.maximum(w, FAINT * w.max()), 0.0)


def pairs_of(tables: Array) -> list[Array]:
    """Return the tables of two 8-bit frames as one: at z1 + 256 z2 stands T1(z1) + T2(z2)."""
    count, channels, n = tables.shape
    if n > 256:
        return list(tables)
    firsts, seconds = tables[0 : count - 1 : 2, :, None, :], tables[1::2, :, :, None]
    return [*(seconds + firsts).reshape(-1, channels, n * n), *tables[count - count % 2 :]]


def planes_of(frames: list[Array]) -> Array:
    """Return the frames' rows (rows, W, C) as planes (K, C, rows, W): colour never in an inner loop.

    Two 8-bit frames make one plane, z1 + 256 z2: half as many elements to copy, and the index into the pair's
    table.
    """
    if frames[0].dtype == np.uint8:
        pairs = zip(frames[::2], frames[1::2], strict=False)
        both = [np.multiply(second, 256, dtype=np.uint16) + first for first, second in pairs]
        frames = both + frames[2 * len(both) :]
    rows, width, channels = frames[0].shape
    planes = np.empty((len(frames), channels, rows, width), np.uint16)
    for (k, frame), c in product(enumerate(frames), range(channels)):
        planes[k, c] = frame[..., c]
    return planes


def veto(planes: Array, n: int, top: int) -> Array:
    """Return the planes with level 0, which weighs nothing, in all channels where a frame clips one."""
    Z = planes.view(np.uint8 if n == 256 else np.uint16)  # each element a level: of pairs, (K, C, rows, 2 W)
    whole = Z.max(axis=1, keepdims=True) < top
    return np.multiply(Z, whole, out=Z).view(np.uint16)


def sums(planes: Array, tables: list[Array]) -> Array:
    """Return sum_j a_j(Z_j) + i sum_j b_j(Z_j) of one channel, (rows, W), from its planes (K, rows, W)."""
    total = tables[0].take(planes[0], mode="clip")  # "clip" only spares the check: no level lies outside
    term = np.empty_like(total)
    for index, table in zip(planes[1:], tables[1:], strict=True):
        table.take(index, out=term, mode="clip")
        total += term
    return total


def merge_block(frames: list[Array], shown: Array | None, plan: Plan, E: Array, seen: Array) -> None:
    """Fill a block of rows, E (rows, W, C) and seen (rows, W), from the frames' rows (rows, W, C)."""
    masked = frames
    if shown is not None:
        masked = [frame * one[..., None] for frame, one in zip(frames, shown, strict=True)]
    planes = veto(planes_of(masked), plan.tables.shape[-1], plan.top)
    seen[:] = Seen.MEASURED
    for c in range(len(plan.curves)):
        total = sums(planes[:, c], [table[c] for table in plan.pairs])
        with np.errstate(divide="ignore", invalid="ignore"):
            mean = total.real / total.imag
        E[..., c] = plan.finish(mean)
        if np.isnan(mean).any():  # 0 / 0
            y, x = np.nonzero(np.isnan(mean))
            Z = np.stack([frame[y, x, c] for frame in frames])
            E[y, x, c], flags = unmeasured(Z, Z >= 0 if shown is None else shown[:, y, x], c, plan)
            seen[y, x] |= flags


def unmeasured(Z: Array, shown: Array, c: int, plan: Plan) -> tuple[Array, Array]:
    """Return E (M,) and flags (M,): without the other channels' veto where that helps, else the bounds."""
    E, flags = bound(Z, plan.B, plan.curves[c], plan.top, shown)
    alone = sum(table[c][levels] for table, levels in zip(plan.tables, Z * shown, strict=True))
    measured = alone.imag > 0
    E[measured] = plan.finish(alone[measured].real / alone[measured].imag)
    flags[measured] = Seen.MEASURED
    return E, flags
