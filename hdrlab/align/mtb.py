"""Alignment by median threshold bitmaps (Ward, Journal of Graphics Tools 8(2), 2003).

Y       gray photograph     (H, W) uint8: codes 0 ... 255, whatever depth the photograph has
h       histogram of Y      (256,) counts
q       percentile          0.5, the median
t       threshold           the code that a fraction q of the pixels does not exceed
bits    of one photograph   (2, H, W) bool: bitmap Y > t, and exclusion bitmap |Y - t| > 4
offset  (dy, dx) pixels     where a photograph must move, down and right, to lie on another
error   disagreement        bits that differ / bits compared, over the overlap alone

`fast.mtb` does the same with 64 pixels to a machine word; `diagnostics.registration` says what to
trust.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise, product
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import Array, ArrayLike, Mask, NDArray
from hdrlab.errors import InputError

# codes: closer than this to the threshold, noise decides the bit
NOISE = 4
# pixels: a level with a side below this is not halved again
SMALLEST = 16
# codes: a threshold this close to 0 or 255 leaves too little on its other side
CLIPPED = 12
# the centre, its sides, its corners: of equal errors the first wins, so in a tie nothing moves
NINE = sorted(product((-1, 0, 1), repeat=2), key=lambda d: d[0] ** 2 + d[1] ** 2)


class State(NamedTuple):
    """One level of one pair, the coarsest first; level 0 is full resolution.

    `fixed` and `moving` (2, H, W) are the bits of both photographs, `errors` those of the nine
    offsets around twice the one that came from the level above, `offset` is the best of them.
    """

    level: int
    fixed: Mask
    moving: Mask
    errors: dict[tuple[int, int], float]
    offset: tuple[int, int]


def gray(image: Array, *, luma: bool = False) -> Array:
    """Return Y = (54 R + 183 G + 19 B) / 256, or green alone, which is faster [Ward03 allows either]."""
    Z = image if image.ndim == 2 or luma else image[..., 1]
    Y = Z >> 8 * (Z.itemsize - 1)  # of 16 bits the upper eight
    return (Y if Y.ndim == 2 else Y @ (54, 183, 19) // 256).astype(np.uint8)


def shrink(Y: Array) -> Array:
    """Return Y at half the size: the mean of each 2 x 2 pixels, rounded; an odd row or column is left out.

    Examples
    --------
    >>> shrink(np.array([[0, 10, 4, 4], [20, 30, 4, 4]], np.uint8)).tolist()
    [[15, 4]]
    """
    Y = Y[: len(Y) // 2 * 2, : Y.shape[1] // 2 * 2].astype(np.uint16)
    return ((Y[::2, ::2] + Y[1::2, ::2] + Y[::2, 1::2] + Y[1::2, 1::2] + 2) // 4).astype(np.uint8)


def threshold(h: Array, q: ArrayLike) -> NDArray[np.int64]:
    """Return t, the lowest code with a fraction q of the pixels at or below it: for q = 0.5 the median."""
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
    """Return bits that differ / bits compared: XOR, AND with both exclusions, over the overlap; 0 of none."""
    (dy, dx), (H, W) = offset, fixed.shape[1:]
    A, A_kept = fixed[:, max(dy, 0) : max(H + dy, 0), max(dx, 0) : max(W + dx, 0)]
    B, B_kept = moving[:, max(-dy, 0) : max(H - dy, 0), max(-dx, 0) : max(W - dx, 0)]
    return float(((A ^ B) & A_kept & B_kept).sum() / max((A_kept & B_kept).sum(), 1))


def step(fixed: Mask, moving: Mask, offset: tuple[int, int]) -> dict[tuple[int, int], float]:
    """Return the errors of the nine offsets around one, itself the first."""
    near = [(offset[0] + dy, offset[1] + dx) for dy, dx in NINE]
    return {one: error(fixed, moving, one) for one in near}


def search(fixed: Array, moving: Array, *, bits: int = 6, q: float = 0.5) -> Iterator[State]:
    """Yield a State per level of two Y: the best of nine, and twice that is where the next level begins."""
    pyramid = [(fixed, moving)]
    while len(pyramid) < bits and min(pyramid[-1][0].shape) >= SMALLEST:
        pyramid.append((shrink(pyramid[-1][0]), shrink(pyramid[-1][1])))
    offset = (0, 0)
    for level in reversed(range(len(pyramid))):
        A, B = (bitmaps(Y, q) for Y in pyramid[level])
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
    """Return the offsets (P, 2) onto the middle of `order`: sums of the steps, of which k lays k on k + 1."""
    sums = np.cumsum(np.reshape(steps, (-1, 2))[::-1], axis=0)[::-1]  # onto the brightest
    offsets = np.zeros((len(order), 2), np.int64)
    offsets[order[:-1]] = sums
    return offsets - offsets[order[len(order) // 2]]


def align_steps(images: ArrayLike, *, bits: int = 6, luma: bool = False) -> Iterator[State]:
    """Yield the States of pair after pair of neighbours in brightness, from dark to bright."""
    images = np.asarray(images)
    if (
        images.ndim < 3
        or images.shape[3:] not in ((), (3,))
        or images.dtype.kind != "u"
        or bits < 1
    ):
        raise InputError(
            f"expected photographs (P, H, W[, 3]) and bits > 0, got {images.shape}, {bits=}"
        )
    for moving, fixed in pairwise(by_brightness(images)):
        yield from search(
            gray(images[fixed], luma=luma), gray(images[moving], luma=luma), bits=bits
        )


def align(images: ArrayLike, *, bits: int = 6, luma: bool = False) -> NDArray[np.int64]:
    """Return the offsets that lay every image on the one in the middle of their brightness.

    Each image is compared with its neighbours in brightness, whose bitmaps are most alike, and the
    offsets are summed along the chain.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3), uint8 or uint16
        Photographs of one scene with different exposures, in any order.
    bits : int
        Levels of the pyramid: neighbours are at most 2^bits - 1 pixels apart, fewer in small
        images.
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
    found = [
        state.offset for state in align_steps(images, bits=bits, luma=luma) if state.level == 0
    ]
    return chain_offsets(by_brightness(np.asarray(images)), found)


def percentile(*histograms: Array, near: float = 0.5) -> float | None:
    """Return the q nearest to the median whose threshold divides every one of the photographs, or None.

    Ward goes to the 17th or 83rd percentile where the median is clipped. Any percentile cuts all
    photographs of a scene along one line of equal light.
    """
    q = np.linspace(0, 1, 1001)
    q = q[np.all([divides(h)[threshold(h, q)] for h in histograms], axis=0)]
    return float(q[np.argmin(np.abs(q - near))]) if len(q) else None


def divides(h: Array) -> Mask:
    """Return for each code whether it can be a threshold: not clipped, and half the pixels not excluded."""
    z, near = np.arange(256), np.convolve(h, np.ones(2 * NOISE + 1), mode="same")
    return (z >= CLIPPED) & (z < 256 - CLIPPED) & (near <= h.sum() / 2)
