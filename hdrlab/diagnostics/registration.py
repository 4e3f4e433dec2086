"""May I trust an alignment? A search always answers, so its answer is compared once more, at full resolution.

H        homography          (3, 3): where pixel (x, y, 1) of the moving photograph lies on the fixed one
p        pixels              (n, 2): those at which light is compared, spread evenly
d        differences         of light (n,): relative to it, NaN where one measures none; of bitmaps (4, 2):
                             in each quarter of the picture the bits that differ, and those compared
e        error               mean of d^2, see `align.light`; bits that differ / bits compared
near     differences 2 pixels further than H, in eight directions
far      differences 8 pixels further

Of Ward's brackets 84 % came out well; the others had turned, moved too far, or were all fine texture. So: is
H better than the identity, better than what lies around it, do the four quarters of the picture agree (in a
rotation each of them moves another way), and does a texture that repeats fit elsewhere as well?
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.fft import fftshift, irfft2, rfft2

from hdrlab.align import light
from hdrlab.align.cerman import peaks
from hdrlab.align.mtb import exclusion
from hdrlab.core import warp
from hdrlab.core.types import F32, F64, Array, Mask

# pixels: the distances at which other answers are compared
NEAR, FAR = 2, 8
# standard errors by which an error is clearly lower
SURE = 3
# confidence below which an answer is lost; wrong ones stay below 0.1, and right ones come to 0.6 and more
LOST = 0.3
# shifts at which a texture resembles itself most
RIVALS = 4
# of the way up to the error elsewhere: a rival this low fits as well
ALIKE = 0.1
# pixels of a bitmap and of light: in this large a part of the picture, its middle, rivals are looked for
BITS_TILE, LIGHT_TILE = 96, 512
# of the rows of a bitmap, this fraction is compared near and far
ROWS = 4
EIGHT = np.array([(dy, dx) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if dy or dx])


class Validation(NamedTuple):
    """What the comparison of two photographs found.

    Attributes
    ----------
    moving, fixed : which two images; they are neighbours in brightness, and the darker one moves
    H : (3, 3), where pixel (x, y, 1) of `moving` comes to lie on `fixed`
    offset : (dy, dx), pixels, by which the middle of `moving` is moved
    degrees : by how much it is rotated, clockwise as seen
    before, after : error without the move and with it
    confidence : 1 is a perfect match, 0 is no better than 8 pixels away
    informative : False where the two photographs cannot be compared
    failure : the reason not to trust H; empty where there is none
    """

    moving: int
    fixed: int
    H: F64
    offset: tuple[float, float]
    degrees: float
    before: float
    after: float
    confidence: float
    informative: bool
    failure: str

    @property
    def reliable(self) -> bool:
        """Whether no reason was found not to trust H."""
        return not self.failure


class Comparison(NamedTuple):
    """Two photographs, ready to be compared after any H.

    Attributes
    ----------
    moving, fixed : which two images
    shape : of the fixed one
    differences : function of H, and of n: every n-th row of bits will do; returns d
    error : function of d that returns e, and `light.NONE` where the two share too little
    lower : function of two d that returns (5,), whether the first is clearly lower in a quarter, in the whole
    middle : (h, w), the middle of the fixed photograph, NaN where it measures nothing
    """

    moving: int
    fixed: int
    shape: tuple[int, ...]
    differences: Callable[..., F64]
    error: Callable[[F64], float]
    lower: Callable[[F64, F64], Mask]
    middle: F32


def compare_light(moving: int, fixed: int, X: F32) -> Comparison:
    """Return the Comparison of light X (2, H, W): the gain of one H over another is taken pixel by pixel."""
    p = light.lattice(X.shape[1:])
    right, low = (p > p.max(axis=0) / 2).T
    quarters = np.eye(4, dtype=np.float32)[right + 2 * low]

    def differences(H: F64, every: int = 1) -> F64:
        return light.differences(X, H, p)

    def lower(d: F64, other: F64) -> Mask:
        gain = other**2 - d**2
        kept = np.isfinite(gain)
        gain = np.where(kept, gain, 0)
        sums = np.stack([kept, np.where(kept, other**2, 0), gain, gain**2]) @ quarters
        n, rate, gained, square = np.column_stack([sums, sums.sum(axis=1)])
        rate, gained, square = np.array([rate, gained, square]) / np.maximum(n, 1)
        error = np.sqrt(np.maximum(square - gained**2, 0) / np.maximum(n, 1))
        return np.asarray((n >= 20) & (gained > rate / 20 + SURE * error))

    return Comparison(moving, fixed, X.shape[1:], differences, light.error, lower, _middle(X[0], LIGHT_TILE))


def compare_bits(
    moving: int, fixed: int, Y: Array, t: int, count: Callable[[tuple[int, int], int], Array]
) -> Comparison:
    """Return the Comparison of the bitmaps of two gray photographs; its H shift by whole pixels.

    Y and t are the fixed one and its threshold; count(offset, n) returns d of every n-th row.
    """
    tile = _middle(Y, BITS_TILE)
    signs = np.where(exclusion(tile, t), np.where(tile > t, 1, -1), np.nan).astype(np.float32)

    def differences(H: F64, every: int = 1) -> F64:
        return np.asarray(count((round(H[1, 2]), round(H[0, 2])), every), np.float64)

    def error(d: F64) -> float:
        differ, compared = d.sum(axis=0)
        return float(differ / compared) if compared else light.NONE

    def lower(d: F64, other: F64) -> Mask:
        d, other = (np.vstack([one, one.sum(axis=0)]) for one in (d, other))
        own, rate = (one[:, 0] / np.maximum(one[:, 1], 1) for one in (d, other))
        return np.asarray(rate - own > rate / 20 + SURE * np.sqrt(rate / np.maximum(other[:, 1], 1)))

    return Comparison(moving, fixed, Y.shape, differences, error, lower, signs)


def validate(pair: Comparison, H: F64, *, limit: float = np.inf) -> Validation:
    """Return the Validation of a pair whose search, of up to `limit` pixels, found H.

    The identity takes the place of an H that is not clearly better.
    """
    before, d = pair.differences(np.eye(3)), pair.differences(H)
    if pair.error(before) < light.NONE and not pair.lower(d, before)[-1]:
        H, d = np.eye(3), before
    near, far = ([pair.differences(shift(H, n * step), ROWS) for step in EIGHT] for n in (NEAR, FAR))
    errors, elsewhere = (pair.error(before), pair.error(d)), [pair.error(one) for one in far]
    if errors[1] == light.NONE or not any(pair.error(one) > 0 for one in near + far):
        return uninformative(pair.moving, pair.fixed, H)
    d = pair.differences(H, ROWS)
    sure = confidence(pair.error(d), elsewhere)
    middle = (np.array(pair.shape[::-1]) - 1) / 2
    dx, dy = warp.apply(H, [middle])[0] - middle
    reason = failure_reason(pair, H, d, near, far, limit if max(abs(dx), abs(dy)) >= limit else None)
    degrees = float(np.rad2deg(np.arctan2(H[1, 0], H[0, 0])))
    return Validation(
        pair.moving, pair.fixed, H, (float(dy), float(dx)), degrees, *errors, sure, True, reason
    )


def uninformative(moving: int, fixed: int, H: F64 | None = None) -> Validation:
    """Return the Validation of a pair that cannot be compared."""
    reason = "uninformative: both measure too little of the scene, or no threshold divides both pictures"
    return Validation(
        moving, fixed, np.eye(3) if H is None else H, (0.0, 0.0), 0.0, 0.0, 0.0, 0.0, False, reason
    )


def failure_reason(
    pair: Comparison, H: F64, d: F64, near: list[F64], far: list[F64], limit: float | None
) -> str:
    """Return the reason not to trust H, whose differences are d, or an empty string."""
    if limit is not None:
        return f"the offset lies at the end of the range, {limit} pixels"
    e, elsewhere = pair.error(d), [pair.error(one) for one in far]
    if not any(elsewhere):
        return f"the picture repeats itself: {FAR} pixels away the photographs fit as well"
    if (sure := confidence(e, elsewhere)) < LOST:
        return f"8 pixels away the photographs fit nearly as well (confidence {sure:.2f})"
    if not all(pair.lower(d, one)[-1] for one in near):
        return "2 pixels away the photographs fit as well"
    if away := np.any([pair.lower(one, d)[:-1] for one in near], axis=0).sum():
        return f"{away} of 4 quarters of the picture fit better elsewhere (rotation, depth or motion)"
    for rival in rivals(pair.middle):
        also = pair.error(pair.differences(shift(H, rival), ROWS))
        if confidence(e, [also]) < LOST or also - e < ALIKE * (np.mean(elsewhere) - e):
            return f"the picture repeats itself: moved on by {tuple(rival.tolist())} it fits nearly as well"
    return ""


def confidence(e: float, elsewhere: Sequence[float]) -> float:
    """Return 1 - e / the mean error elsewhere: 1 is a perfect match, 0 no better than elsewhere.

    Examples
    --------
    >>> confidence(0.25, [1.0, 1.5])
    0.8
    """
    mean = float(np.mean(elsewhere))
    return 1 - e / mean if mean > 0 else 0.0


def rivals(middle: F32) -> list[Array]:
    """Return the shifts at which a picture resembles itself most: peaks of its autocorrelation."""
    x = np.where(np.isfinite(middle), middle - light.local_mean(middle), 0)
    h, w = x.shape
    c = fftshift(irfft2(np.abs(rfft2(x, (2 * h, 2 * w))) ** 2, (2 * h, 2 * w)))
    found = peaks(c[:, w:], RIVALS + 1) + [0, w // 2]  # c is symmetric
    return [shift for shift in found if np.abs(shift).max() > NEAR]


def shift(H: F64, offset: ArrayLike) -> F64:
    """Return H, and then an offset (dy, dx) further."""
    return np.asarray(warp.as_homographies(np.reshape(offset, (1, 2)))[0] @ H)


def _middle(image: Array, side: int) -> Array:
    """Return the middle of a picture (H, W), of this side at most."""
    rows, columns = (slice(max(n - side, 0) // 2, max(n - side, 0) // 2 + side) for n in image.shape)
    return image[rows, columns]
