"""Alignment by median threshold bitmaps (Ward, Journal of Graphics Tools 8(2), 2003).

Y       gray photograph      (H, W) uint8: codes 0 ... 255, whatever depth the photograph has
h       histogram of Y       (256,) counts
q       percentile           0.5, the median, unless that is clipped in one of two photographs
t       threshold            the code that a fraction q of the pixels does not exceed
bits    of one photograph    (2, H, ceil(W / 64)) uint64: bitmap Y > t, and exclusion bitmap |Y - t| > 4
offset  (dy, dx) pixels      where a photograph must move, down and right, to lie on another
error   disagreement         bits that differ / bits compared, over the overlap alone

The bits are packed, 64 pixels to a word; `bitmaps` has XOR, AND and counting, `pyramid` gray and the levels.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.align.bitmaps import Mask, Offset, Words, around, error, pack, unpack
from hdrlab.align.judge import NEAR, judge
from hdrlab.align.pairs import Verdict, along, blind, by_brightness
from hdrlab.align.pyramid import Frame, Gray, Histogram, frame
from hdrlab.core.arrays import as_stack

NOISE = 4  # codes: closer than this to the threshold, noise decides the bit
CACHE = 2**18  # pixels
NEAREST = [4, 1, 3, 5, 7, 0, 2, 6, 8]  # of the nine offsets: the centre, its sides, its corners
CLIPPED = 12  # codes: a threshold this close to 0 or 255 leaves too little on its other side
OTHERS = (0.83, 0.17)  # percentiles that are tried where the median leaves a doubt
CERTAIN = 0.9  # confidence of what is taken from them


class State(NamedTuple):
    """One level of one pair, the coarsest first; level 0 is full resolution.

    Image `moving` is laid on image `fixed`; `thresholds` and `bits` hold the fixed one first. `errors` (3, 3)
    are those of the nine offsets around the one that came from the level above, `offset` is the best of them.
    """

    moving: int
    fixed: int
    level: int
    width: int
    q: float
    thresholds: tuple[int, int]
    bits: tuple[Words, Words]
    errors: NDArray[np.float64]
    offset: Offset

    @property
    def bitmaps(self) -> Mask:
        """The two bitmaps as pictures, (2, H, W) bool."""
        return np.stack([unpack(bits[0], self.width) for bits in self.bits])

    @property
    def exclusions(self) -> Mask:
        """The two exclusion bitmaps as pictures, (2, H, W) bool: True where a pixel is compared."""
        return np.stack([unpack(bits[1], self.width) for bits in self.bits])


def threshold(h: Histogram, q: ArrayLike) -> NDArray[np.int64]:
    """Return t, the lowest code with a fraction q of the pixels at or below it: for q = 0.5 the median."""
    below = np.cumsum(h)
    return np.searchsorted(below, np.asarray(q) * below[-1])


def divides(h: Histogram) -> Mask:
    """Return for each code whether it can be a threshold: not clipped, and half the pixels not excluded."""
    z, near = np.arange(256), np.convolve(h, np.ones(2 * NOISE + 1), mode="same")
    return (z >= CLIPPED) & (z < 256 - CLIPPED) & (near <= h.sum() / 2)


def percentile(*histograms: Histogram, near: float = 0.5) -> float | None:
    """Return the q nearest to the median whose threshold divides every one of the photographs, or None.

    Ward goes to the 17th or 83rd percentile where the median is clipped. Any percentile cuts all photographs
    of a scene along one line; which line all of them show is for the pair to say.
    """
    q = np.linspace(0, 1, 1001)
    serves = np.all([divides(h)[threshold(h, q)] for h in histograms], axis=0)
    return float(min(q[serves], key=lambda one: abs(one - near))) if serves.any() else None


def bitmap(Y: Gray, t: int) -> Mask:
    """Return Y > t."""
    return Y > t


def exclusion(Y: Gray, t: int) -> Mask:
    """Return |Y - t| > 4: False where the pixel is excluded."""
    return (Y > t + NOISE) | (Y < t - NOISE)


def cut(Y: Gray, t: int) -> Words:
    """Return the bits of a photograph, bitmap and exclusion bitmap, made in bands that fit the cache."""
    bands = np.array_split(Y, Y.size // CACHE + 1)
    return np.concatenate([np.stack([pack(bitmap(Z, t)), pack(exclusion(Z, t))]) for Z in bands], axis=1)


def step(fixed: Words, moving: Words, offset: Offset) -> tuple[NDArray[np.float64], Offset]:
    """Return the errors (3, 3) of the nine offsets around `offset`, and the best; in a tie the least move.

    A scan that begins in a corner walks off diagonally, a pixel per level, wherever all nine are equal; or
    along the bars of a fence, which tell one direction alone.
    """
    errors = error(around(fixed, moving, offset))
    i, j = divmod(NEAREST[int(np.argmin(errors.ravel()[NEAREST]))], 3)
    return errors, (offset[0] + i - 1, offset[1] + j - 1)


def search(fixed: Frame, moving: Frame, *, near: float = 0.5) -> Iterator[State]:
    """Yield a State per level: the best of nine, and twice that is where the next level begins."""
    q = percentile(fixed.h[0], moving.h[0], near=near)
    if q is None:
        return
    offset = (0, 0)
    for level in reversed(range(len(fixed.Y))):
        t = int(threshold(fixed.h[level], q)), int(threshold(moving.h[level], q))
        A, B = cut(fixed.Y[level], t[0]), cut(moving.Y[level], t[1])
        errors, offset = step(A, B, (2 * offset[0], 2 * offset[1]))
        yield State(moving.image, fixed.image, level, fixed.Y[level].shape[1], q, t, (A, B), errors, offset)


def neighbours(
    images: ArrayLike | Sequence[ArrayLike], bits: int, luma: bool
) -> Iterator[tuple[Frame, Frame]]:
    """Yield (fixed, moving) from dark to bright, with no more than two pyramids in memory."""
    images = as_stack(images)
    if bits < 1:
        raise ValueError(f"expected at least 1 bit for the largest offset, got bits={bits}")
    moving = None
    for image in by_brightness(images):
        fixed = frame(images, image, bits=bits, luma=luma)
        if moving is not None:
            yield fixed, moving
        moving = fixed


def align_steps(
    images: ArrayLike | Sequence[ArrayLike], *, bits: int = 6, luma: bool = False
) -> Iterator[State]:
    """Yield the States of pair after pair, from dark to bright; one without a threshold has none."""
    for fixed, moving in neighbours(images, bits, luma):
        yield from search(fixed, moving)


def searched(fixed: Frame, moving: Frame, *, near: float = 0.5) -> Verdict:
    """Return what a search found for a pair, and whether to trust it."""
    levels, pair = list(search(fixed, moving, near=near)), (moving.image, fixed.image)
    if not levels:
        return blind(*pair)
    return judge(pair, *levels[-1].bits, levels[-1].offset, limit=2 ** len(levels) - 1)


def verdict(fixed: Frame, moving: Frame) -> Verdict:
    """Return what was found for a pair; Ward's other percentiles are asked where the median's search is lost.

    Such a second answer must be beyond doubt and lie elsewhere: photographs that turned fit nearby, too.
    """
    first = searched(fixed, moving)
    others = (searched(fixed, moving, near=near) for near in OTHERS) if first.trouble else iter(())
    sure = (one for one in others if one.confidence > CERTAIN and not one.trouble and apart(one, first))
    return next(sure, first)


def apart(one: Verdict, other: Verdict) -> bool:
    """Return whether two answers lie more than 2 pixels from each other."""
    return bool(np.max(np.abs(np.subtract(one.offset, other.offset))) > NEAR)


def verdicts(
    images: ArrayLike | Sequence[ArrayLike], *, bits: int = 6, luma: bool = False
) -> tuple[Verdict, ...]:
    """Return the Verdict on every pair of neighbours in brightness, from dark to bright; knobs of `align`."""
    return tuple(verdict(fixed, moving) for fixed, moving in neighbours(images, bits, luma))


def align(images: ArrayLike | Sequence[ArrayLike], *, bits: int = 6, luma: bool = False) -> NDArray[np.int64]:
    """Return the offsets that lay every image on the one in the middle of their brightness.

    Each image is compared with its neighbours in brightness, whose bitmaps are most alike, and the offsets
    are summed along the chain. A pair's offset counts only where the bitmaps then agree clearly better than
    with none at all. `verdicts` tells which pairs to doubt; `pairs.along` sums them up.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3), uint8 or uint16
        Photographs of one scene with different exposures, in any order.
    bits : int
        Levels of the pyramid: neighbours are at most 2^bits - 1 pixels apart, fewer in small images.
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
    Ward, "Fast, Robust Image Registration for Compositing High Dynamic Range Photographs from Hand-Held
    Exposures", Journal of Graphics Tools 8(2), 2003.

    Examples
    --------
    >>> import numpy as np
    >>> from skimage.data import camera
    >>> from hdrlab.align import mtb
    >>> images = np.stack([camera()[8:456, 8:456] // 2, camera()[5:453, 10:458]])
    >>> mtb.align(images).tolist()
    [[3, -2], [0, 0]]
    """
    return along(verdicts(images, bits=bits, luma=luma))
