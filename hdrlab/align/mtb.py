"""Alignment by median threshold bitmaps (Ward, Journal of Graphics Tools 8(2), 2003).

Y       gray photograph     (H, W) uint8: codes 0 ... 255, whatever depth the photograph has
h       histogram of Y      (256,) counts
q       percentile          0.5, the median
t       threshold           the code that a fraction q of the pixels does not exceed
bits    of one photograph   (2, H, W) bool: bitmap Y > t, and exclusion bitmap |Y - t| > 4
offset  (dy, dx) pixels     where a photograph must move, down and right, to lie on another
error   disagreement        bits that differ / bits compared, over the overlap alone

`fast.mtb` computes the same with 64 pixels in a machine word; `diagnostics.registration` checks
whether an alignment can be trusted.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise, product
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import Array, ArrayLike, Mask, NDArray
from hdrlab.errors import InputError

# codes: closer than this to the threshold, noise decides the bit
NOISE = 4
# A level is halved as long as its smaller side has at least this many pixels.
MIN_SIDE_PIXELS = 16
# The center, its sides, its corners: of equal errors the first wins, so in a tie nothing moves.
NINE_OFFSETS = sorted(product((-1, 0, 1), repeat=2), key=lambda d: d[0] ** 2 + d[1] ** 2)
# A threshold within this many codes of 0 or 255 leaves too few pixels on its other side.
_CLIPPED_CODES = 12
# The percentiles that are tried, of 0 to 1.
_PERCENTILES = np.linspace(0, 1, 1001)


class State(NamedTuple):
    """One level of one pair, the coarsest first; level 0 is full resolution.

    `fixed` and `moving` (2, H, W) are the bits of both photographs. `errors` are the errors of the
    nine offsets around twice the offset of the level above, and `offset` is the best of them.
    """

    level: int
    fixed: Mask
    moving: Mask
    errors: dict[tuple[int, int], float]
    offset: tuple[int, int]


def gray(image: Array, *, luma: bool = False) -> Array:
    """Return Y = (54 R + 183 G + 19 B) / 256, or green alone, which is faster [Ward03 allows either]."""
    Z = image if image.ndim == 2 or luma else image[..., 1]
    Y = Z >> 8 * (Z.itemsize - 1)  # the upper eight of 16 bits
    if Y.ndim == 3:
        Y = Y @ (54, 183, 19) // 256
    return Y.astype(np.uint8)


def shrink(Y: Array) -> Array:
    """Return Y at half the size: the rounded mean of each 2 x 2 pixels, without an odd row or column.

    Examples
    --------
    >>> shrink(np.array([[0, 10, 4, 4], [20, 30, 4, 4]], np.uint8)).tolist()
    [[15, 4]]
    """
    Y = Y[: len(Y) // 2 * 2, : Y.shape[1] // 2 * 2].astype(np.uint16)
    return ((Y[::2, ::2] + Y[1::2, ::2] + Y[::2, 1::2] + Y[1::2, 1::2] + 2) // 4).astype(np.uint8)


def threshold(h: Array, q: ArrayLike) -> NDArray[np.int64]:
    """Return t, the lowest pixel value with a fraction q of the pixels at or below it."""
    below = np.cumsum(h)
    return np.searchsorted(below, np.asarray(q) * below[-1])


def exclusion(Y: Array, t: int) -> Mask:
    """Return |Y - t| > 4: False where the pixel is excluded."""
    return (Y > t + NOISE) | (Y < t - NOISE)


def bitmaps(Y: Array, q: float = 0.5) -> Mask:
    """Return the bits of a photograph, Y > t and the exclusion bitmap."""
    t = int(threshold(np.bincount(Y.ravel(), minlength=256), q))
    return np.stack([t < Y, exclusion(Y, t)])


def error(fixed: Mask, moving: Mask, offset: tuple[int, int]) -> float:
    """Return bits that differ / bits compared, over the overlap: XOR, then AND with both exclusions.

    Without any bit to compare it is 0.
    """
    dy, dx = offset
    H, W = fixed.shape[1:]
    A, A_kept = fixed[:, max(dy, 0) : max(H + dy, 0), max(dx, 0) : max(W + dx, 0)]
    B, B_kept = moving[:, max(-dy, 0) : max(H - dy, 0), max(-dx, 0) : max(W - dx, 0)]
    compared = A_kept & B_kept
    return float(((A ^ B) & compared).sum() / max(compared.sum(), 1))


def step(fixed: Mask, moving: Mask, offset: tuple[int, int]) -> dict[tuple[int, int], float]:
    """Return the errors of the nine offsets around an offset, its own first."""
    y, x = offset
    errors = {}
    for dy, dx in NINE_OFFSETS:
        neighbor = (y + dy, x + dx)
        errors[neighbor] = error(fixed, moving, neighbor)
    return errors


def search(fixed: Array, moving: Array, *, bits: int = 6, q: float = 0.5) -> Iterator[State]:
    """Yield a State per level of two Y, the coarsest first.

    Each level takes the best of nine offsets; the next level starts from twice that offset.
    """
    pyramid = [(fixed, moving)]
    while len(pyramid) < bits and min(fixed.shape) >= MIN_SIDE_PIXELS:
        fixed = shrink(fixed)
        moving = shrink(moving)
        pyramid.append((fixed, moving))
    offset = (0, 0)
    for level in reversed(range(len(pyramid))):
        fixed, moving = pyramid[level]
        A = bitmaps(fixed, q)
        B = bitmaps(moving, q)
        errors = step(A, B, (2 * offset[0], 2 * offset[1]))
        offset = min(errors, key=errors.__getitem__)
        yield State(level, A, B, errors, offset)


def by_brightness(images: Array) -> list[int]:
    """Return the order of the images from dark to bright, by the mean of every eighth pixel.

    Examples
    --------
    >>> by_brightness(np.array([200, 10, 90], np.uint8)[:, None, None] * np.ones((1, 16, 16), np.uint8))
    [1, 2, 0]
    """
    return np.argsort([image[::8, ::8].mean() for image in images], kind="stable").tolist()


def chain_offsets(order: Sequence[int], steps: ArrayLike) -> NDArray[np.int64]:
    """Return the offsets (P, 2) onto the middle image of `order`, as sums of the steps.

    Step k moves image order[k] onto image order[k + 1].
    """
    sums = np.cumsum(np.reshape(steps, (-1, 2))[::-1], axis=0)[::-1]  # onto the brightest
    offsets = np.zeros((len(order), 2), np.int64)
    offsets[order[:-1]] = sums
    return offsets - offsets[order[len(order) // 2]]


def align_steps(images: ArrayLike, *, bits: int = 6, luma: bool = False) -> Iterator[State]:
    """Yield the States of pair after pair of neighbors in brightness, from dark to bright."""
    images = np.asarray(images)
    is_stack = images.ndim >= 3 and images.shape[3:] in ((), (3,))
    if not is_stack or images.dtype.kind != "u" or bits < 1:
        raise InputError(
            f"expected photographs (P, H, W[, 3]) and bits > 0, got {images.shape}, {bits=}"
        )
    for moving, fixed in pairwise(by_brightness(images)):
        Y_fixed = gray(images[fixed], luma=luma)
        Y_moving = gray(images[moving], luma=luma)
        yield from search(Y_fixed, Y_moving, bits=bits)


def align(images: ArrayLike, *, bits: int = 6, luma: bool = False) -> NDArray[np.int64]:
    """Return the offsets that align every image with the one of the middle brightness.

    Each image is compared with its neighbors in brightness, whose bitmaps are most similar, and the
    offsets are summed along the chain.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3), uint8 or uint16
        Photographs of one scene with different exposures, in any order.
    bits : int
        Levels of the pyramid. Offsets of up to 2^bits - 1 pixels between neighbors are found,
        smaller ones in small images.
    luma : bool
        Compare (54 R + 183 G + 19 B) / 256 instead of the green channel.

    Returns
    -------
    offsets : (P, 2) int64, pixels
        (dy, dx), where each image must move, down and right; (0, 0) for the one in the middle.

    Raises
    ------
    ValueError
        For images that are not a stack of photographs, and for bits below 1.

    References
    ----------
    Ward, "Fast, Robust Image Registration for Compositing High Dynamic Range Photographs from
    Hand-Held Exposures", Journal of Graphics Tools 8(2), 2003.

    Examples
    --------
    >>> import numpy as np
    >>> from skimage.data import camera
    >>> from hdrlab.align import mtb
    >>> images = np.stack([camera()[8:456, 8:456] // 2, camera()[5:453, 10:458]])
    >>> mtb.align(images).tolist()
    [[3, -2], [0, 0]]
    """
    states = align_steps(images, bits=bits, luma=luma)
    steps = [state.offset for state in states if state.level == 0]
    return chain_offsets(by_brightness(np.asarray(images)), steps)


def percentile(*histograms: Array, near: float = 0.5) -> float | None:
    """Return the percentile q nearest to the median whose threshold divides all photographs, or None.

    Ward uses the 17th or 83rd percentile where the median is clipped. Any percentile cuts all
    photographs of a scene along the same line of equal light.
    """
    q = _PERCENTILES
    q = q[np.all([divides(h)[threshold(h, q)] for h in histograms], axis=0)]
    return float(q[np.argmin(np.abs(q - near))]) if len(q) else None


def divides(h: Array) -> Mask:
    """Return for each code whether it can be the threshold of a photograph with histogram h.

    It must not be clipped, and at least half of the pixels must not be excluded.
    """
    z = np.arange(256)
    excluded = np.convolve(h, np.ones(2 * NOISE + 1), mode="same")
    is_inside = (z >= _CLIPPED_CODES) & (z < 256 - _CLIPPED_CODES)
    return is_inside & (excluded <= h.sum() / 2)
