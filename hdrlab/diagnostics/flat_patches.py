"""Flat patches of neighbouring frames: the evidence on exposure times.

images  (P, H, W[, 3]) uint8 or uint16, from short to long
Z       levels of patches    (P, C, h, w) uint8, 0 ... 255; 0 where a pixel is clipped or black
flat    of each frame        (P, h, w) bool
best    of each pair         (P - 1, h, w) bool: flat in a frame and in the next, and static
H       pair tables          (P - 1, C, 256, 256): patches of level a in frame j, b in frame j + 1

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

PATCH_SIDE = 7
# levels between the darkest and the brightest pixel of a flat patch
MAX_FLAT_RANGE = 12
# a patch with a pixel below MIN_LEVEL or above MAX_LEVEL is not a measurement
MIN_LEVEL = 4
MAX_LEVEL = 250
# larger photos have about this number of patches, on an even grid
MAX_PATCHES = 60_000
# levels by which a patch may darken or brighten and still count as static
NOISE_LEVELS = 1


class FlatPatches(NamedTuple):
    """Patches Z (P, C, h, w), and which are flat in each frame (P, h, w)."""

    Z: Flags
    flat: Mask

    @property
    def best(self) -> Mask:
        """The patches that are static, and flat in both frames of a pair, (P - 1, h, w)."""
        return self.flat[:-1] & self.flat[1:] & find_static(self.Z)

    def of(self, frames: Sequence[int] | slice) -> "FlatPatches":
        """Return the patches of some of the frames."""
        return FlatPatches(self.Z[frames], self.flat[frames])


def find_flat_patches(images: ArrayLike, *, valid: ArrayLike | None = None) -> FlatPatches:
    """Return the mean levels of the patches of aligned photos, and which patches are flat."""
    stack = as_stack(images)
    mask = as_mask(valid, stack)
    h, w = stack.shape[1:3]
    spacing = PATCH_SIDE * max(1, round(np.sqrt(h * w / MAX_PATCHES) / PATCH_SIDE))
    pixels_per_patch = min(PATCH_SIDE, h) * min(PATCH_SIDE, w)

    def measure_frame(j: int) -> tuple[Flags, Mask]:
        low = to_256(_reduce_patches(stack[j], spacing, np.minimum))
        high = to_256(_reduce_patches(stack[j], spacing, np.maximum))
        total = _reduce_patches(stack[j], spacing, np.add)
        rounded_mean = (total + pixels_per_patch // 2) // pixels_per_patch
        mean = to_256(rounded_mean.astype(stack.dtype))
        is_measured = np.all((low >= MIN_LEVEL) & (high <= MAX_LEVEL), axis=0)
        if mask is not None:
            is_measured &= _reduce_patches(mask[j], spacing, np.minimum)[0]
        is_flat = np.all(high - low <= MAX_FLAT_RANGE, axis=0)
        return np.where(is_measured, mean, 0).astype(np.uint8), is_flat

    frames = list(map_in_threads(measure_frame, range(len(stack)), pixels=stack[0].size))
    return FlatPatches(
        Z=np.stack([mean for mean, _ in frames]),
        flat=np.stack([is_flat for _, is_flat in frames]),
    )


def rank_levels(images: ArrayLike, *, valid: ArrayLike | None = None) -> Flags:
    """Return levels of equal rank as patches Z (P, C, n, 1); 0 where a rank is clipped or black."""
    stack = as_stack(images)
    Z = plausibility.ranks(stack, as_mask(valid, stack))
    is_measured = (Z >= MIN_LEVEL) & (Z <= MAX_LEVEL)
    by_frame = np.moveaxis(np.where(is_measured, Z, 0), 0, -1)
    return by_frame[..., None].astype(np.uint8)


def _reduce_patches(frame: Array, spacing: int, ufunc: np.ufunc) -> Array:
    """Return a reduction over the pixels of each patch, (C, h, w).

    Patches begin `spacing` pixels apart. A frame that is smaller than a patch is one patch. Sums
    have twice the bits of the frame.
    """
    reduced = np.moveaxis(frame.reshape(*frame.shape[:2], -1), -1, 0)
    sum_type = np.dtype(f"u{2 * frame.itemsize}")
    for axis in (1, 2):  # whole rows first, as they lie in memory
        length = reduced.shape[axis]
        side = min(PATCH_SIDE, length)
        offsets: list[Array] = []
        for offset in range(side):
            every_patch = slice(offset, length - side + 1 + offset, spacing)
            offsets.append(reduced[:, every_patch] if axis == 1 else reduced[:, :, every_patch])
        dtype = sum_type if ufunc is np.add else reduced.dtype
        reduced = offsets[0].astype(dtype, "K" if axis == 1 else "C")
        for pixels in offsets[1:]:
            ufunc(reduced, pixels, out=reduced)
    return reduced


def find_static(Z: Flags) -> Mask:
    """Return which patches change in the same direction as most of their pair, (P - 1, h, w).

    That is brighter as a rule.
    """
    in_both = (Z[:-1] > 0) & (Z[1:] > 0)
    change = Z[1:].astype(np.int16) - Z[:-1].astype(np.int16)
    darker = in_both & (change < -NOISE_LEVELS)
    brighter = in_both & (change > NOISE_LEVELS)
    gets_darker = darker.sum(axis=(1, 2, 3)) > brighter.sum(axis=(1, 2, 3))
    return np.where(gets_darker[:, None, None], ~brighter.any(axis=1), ~darker.any(axis=1))


def count_pairs(Z: Flags, chosen: Mask) -> F64:
    """Count the chosen patches of level a in a frame and b in the next, H (P - 1, C, 256, 256).

    chosen : patches of each pair (P - 1, h, w), or of all pairs (h, w)
    """
    P, C = Z.shape[:2]
    H = np.empty((P - 1, C, 256, 256))
    for j, mask in enumerate(np.broadcast_to(chosen, (P - 1, *Z.shape[2:]))):
        a, b = Z[j : j + 2, :, mask].astype(np.intp)
        for c in range(C):
            H[j, c] = np.bincount(256 * a[c] + b[c], minlength=65536).reshape(256, 256)
    H[:, :, 0] = 0
    H[:, :, :, 0] = 0
    return H


def checkerboard(shape: tuple[int, int], *, side: int = 6) -> Mask:
    """Return the black squares of a chessboard over the patches, (h, w).

    One half of the patches is for fitting, the other is held out.

    Examples
    --------
    >>> checkerboard((4, 6), side=2).astype(int).tolist()
    [[1, 1, 0, 0, 1, 1], [1, 1, 0, 0, 1, 1], [0, 0, 1, 1, 0, 0], [0, 0, 1, 1, 0, 0]]
    """
    y, x = np.indices(shape)
    return (y // side + x // side) % 2 == 0
