"""Flat patches of neighbouring frames: the evidence on exposure times.

images  (P, H, W[, 3]) uint8 or uint16, from short to long
Z       levels of patches    (P, C, h, w) uint8, 0 ... 255; 0 where a pixel of it is clipped or black
flat    of each frame        (P, h, w) bool
best    of each pair         (P - 1, h, w) bool: flat in a frame and in the next, and static
H       pair tables          (P - 1, C, 256, 256): patches of level a in frame j and of level b in frame j + 1

At an edge a shift of half a pixel, sharpening and JPEG change levels; in a flat patch they change
nothing. And a longer exposure makes nothing darker: where it seems to, something moved. Each pair
of neighbours has its own flat patches, for hardly a patch is exposed well in all frames of a long
bracket. Where a pair has too few, equal ranks of the two histograms take their place [Grossberg03].
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F64, Array, ArrayLike, Flags, Mask, as_mask, as_stack, to_256
from hdrlab.core.threads import map_in_threads
from hdrlab.diagnostics import plausibility

# of a patch, pixels
SIDE = 7
# levels between the darkest and the brightest pixel of a flat patch
RANGE = 12
# a patch with a pixel below or above is not a measurement
BLACK, TOP = 4, 250
# of larger pictures, about so many on an even grid
PATCHES = 60_000
# levels by which a patch may darken and still count as static
NOISE = 1


class FlatPatches(NamedTuple):
    """Patches Z (P, C, h, w), and which are flat in each frame (P, h, w)."""

    Z: Flags
    flat: Mask

    @property
    def best(self) -> Mask:
        """Which patches are flat in both frames of a pair of neighbours, and static, (P - 1, h, w)."""
        return self.flat[:-1] & self.flat[1:] & find_static(self.Z)

    def of(self, frames: Sequence[int] | slice) -> "FlatPatches":
        """Return the patches of some of the frames."""
        return FlatPatches(self.Z[frames], self.flat[frames])


def find_flat_patches(images: ArrayLike, *, valid: ArrayLike | None = None) -> FlatPatches:
    """Return the patches of aligned photographs: their mean levels, and which are static, and flat."""
    stack = as_stack(images)
    mask = as_mask(valid, stack)
    apart = SIDE * max(1, round(np.sqrt(stack.shape[1] * stack.shape[2] / PATCHES) / SIDE))
    n = int(np.minimum(SIDE, stack.shape[1:3]).prod())

    def find(j: int) -> tuple[Flags, Mask]:
        low, high = (
            to_256(_reduce_patches(stack[j], apart, one)) for one in (np.minimum, np.maximum)
        )
        mean = to_256(
            ((_reduce_patches(stack[j], apart, np.add) + n // 2) // n).astype(stack.dtype)
        )
        whole = ((low >= BLACK) & (high <= TOP)).all(axis=0)
        if mask is not None:
            whole &= _reduce_patches(mask[j], apart, np.minimum)[0]
        return np.where(whole, mean, 0).astype(np.uint8), np.all(high - low <= RANGE, axis=0)

    Z, flat = zip(*map_in_threads(find, range(len(stack)), pixels=stack[0].size), strict=True)
    return FlatPatches(np.stack(Z), np.stack(flat))


def rank_levels(images: ArrayLike, *, valid: ArrayLike | None = None) -> Flags:
    """Return levels of equal rank as patches Z (P, C, n, 1); 0 where a rank is clipped or black."""
    stack = as_stack(images)
    Z = plausibility.ranks(stack, as_mask(valid, stack))
    return np.moveaxis(np.where((Z >= BLACK) & (Z <= TOP), Z, 0), 0, -1)[..., None].astype(np.uint8)


def _reduce_patches(frame: Array, apart: int, ufunc: np.ufunc) -> Array:
    """Return a reduction over the pixels of patches that begin so many pixels apart, (C, h, w).

    Sums have twice the bits. A frame that is smaller than a patch is one.
    """
    few, wide = (
        np.moveaxis(frame.reshape(*frame.shape[:2], -1), -1, 0),
        np.dtype(f"u{2 * frame.itemsize}"),
    )
    for axis in (1, 2):  # whole rows first, as they lie in memory
        side = min(SIDE, n := few.shape[axis])
        parts = [
            few[(*[np.s_[:]] * axis, np.s_[j : n - side + 1 + j : apart])] for j in range(side)
        ]
        few = parts[0].astype(wide if ufunc is np.add else few.dtype, "K" if axis == 1 else "C")
        for part in parts[1:]:
            ufunc(few, part, out=few)
    return few


def find_static(Z: Flags) -> Mask:
    """Return which patches change as most of their pair do, brighter as a rule, (P - 1, h, w)."""
    both, change = (Z[:-1] > 0) & (Z[1:] > 0), Z[1:].astype(np.int16) - Z[:-1].astype(np.int16)
    against = np.stack([both & (change < -NOISE), both & (change > NOISE)])
    count = against.sum(axis=(2, 3, 4))
    darker, brighter = (one.any(axis=1) for one in against)
    return np.where((count[0] > count[1])[:, None, None], ~brighter, ~darker)


def count_pairs(Z: Flags, chosen: Mask) -> F64:
    """Return H (P - 1, C, 256, 256): how many chosen patches have level a in one frame and b in the next.

    chosen : of each pair (P - 1, h, w), or the same of all (h, w)
    """
    P, C = Z.shape[:2]
    H = np.empty((P - 1, C, 256, 256))
    for j, here in enumerate(np.broadcast_to(chosen, (P - 1, *Z.shape[2:]))):
        a, b = Z[j : j + 2, :, here].astype(np.intp)
        for c in range(C):
            H[j, c] = np.bincount(256 * a[c] + b[c], minlength=65536).reshape(256, 256)
    H[:, :, 0], H[:, :, :, 0] = 0, 0
    return H


def checkerboard(shape: tuple[int, int], *, side: int = 6) -> Mask:
    """Return the black squares of a chessboard over the patches, (h, w): half to fit, half to hold out.

    Examples
    --------
    >>> checkerboard((4, 6), side=2).astype(int).tolist()
    [[1, 1, 0, 0, 1, 1], [1, 1, 0, 0, 1, 1], [0, 0, 1, 1, 0, 0], [0, 0, 1, 1, 0, 0]]
    """
    y, x = np.indices(shape)
    return (y // side + x // side) % 2 == 0
