"""May I trust an alignment? A search always answers, so its answer is compared once more.

H        homography          (3, 3): where pixel (x, y, 1) of the moving photograph lies on the fixed one
p        pixels              (n, 2): those at which light is compared, spread evenly over an overview, half a
                             megapixel at most; bitmaps are compared with no offset at full
                             resolution, too
d        differences         of light (n,): relative to it, NaN where one measures none; of bitmaps (4, 2):
                             in each quarter of the picture the bits that differ, and those compared
e        error               mean of d^2, see `align.light`; bits that differ / bits compared
near     differences 2 pixels further than H, in eight directions
far      differences 8 pixels further

Of Ward's brackets 84 % came out well; the others had turned, moved too far, or were all fine
texture. So: is H better than the identity, better than what lies around it, do the four quarters of
the picture agree (in a rotation each of them moves another way), and does a texture that repeats
fit elsewhere as well?
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from hdrlab.align import homography, light, mtb
from hdrlab.core.arrays import F32, F64, Array, ArrayLike, Mask
from hdrlab.core.filters import blur, warp

# pixels of the overview: the distances at which other answers are compared
NEAR, FAR = 2, 8
# standard errors by which an error is clearly lower
SURE = 3
# confidence below which an answer is lost; wrong ones stay below 0.1, and right ones come to 0.6
# and more
LOST = 0.3
# shifts at which a texture resembles itself most
RIVALS = 4
# of the way up to the error elsewhere: a rival this low fits as well
ALIKE = 0.1
# pixels of a bitmap and of light: in this large a part of the picture, its middle, rivals are
# looked for
BITS_TILE, LIGHT_TILE = 64, 512
# error of photographs that clearly lie apart: of bits an eighth as fine, where noise is none, and
# of light
BITS_APART, LIGHT_APART = 0.1, 0.1
# quarters of a picture: so many fit better elsewhere where the camera rotated; fewer, where
# something moved
ROTATED = 3
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
    apart : whether the photographs clearly do not lie on each other, wherever H puts them
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
    apart: bool = False

    @property
    def reliable(self) -> bool:
        """Whether no reason was found not to trust H."""
        return not self.failure

    @property
    def known(self) -> bool:
        """Whether H is clearly better than what lies around it."""
        return self.confidence >= LOST

    @property
    def step(self) -> F64:
        """H where it is known; else the identity, with which a photograph stays beside its neighbour."""
        return self.H if self.known else np.eye(3)


class Comparison(NamedTuple):
    """Two photographs, ready to be compared after any H.

    Attributes
    ----------
    moving, fixed, shape : which two images, and the size of the fixed one
    scale : pixels that are one of the overview
    differences : function of H that returns d of the overview, or of the size whose pixel is so
        many wide
    error : function of d that returns e, and `light.ERROR_WITHOUT_OVERLAP` where the two share too little
    lower : function of two d that returns (5,), whether the first is clearly lower in a quarter, in
        the whole
    middle : (h, w), the middle of the fixed photograph, NaN where it measures nothing
    apart : e above which photographs clearly do not lie on each other
    """

    moving: int
    fixed: int
    shape: tuple[int, ...]
    scale: int
    differences: Callable[..., F64]
    error: Callable[[F64], float]
    lower: Callable[[F64, F64], Mask]
    middle: F32
    apart: float


def compare_light(moving: int, fixed: int, X: F32, scale: int = 1) -> Comparison:
    """Return the Comparison of light X (2, h, w): the gain of one H over another is taken pixel by pixel.

    A pixel of X is `scale` pixels of the photographs wide.
    """
    p = light.lattice(X.shape[1:])
    right, low = (p > p.max(axis=0) / 2).T
    quarters = np.eye(4, dtype=np.float32)[right + 2 * low]

    def differences(H: F64, pixel: int = scale) -> F64:
        return light.differences(X, homography.enlarge(H, 1 / scale), p)

    def lower(d: F64, other: F64) -> Mask:
        gain = other**2 - d**2
        kept = np.isfinite(gain)
        gain = np.where(kept, gain, 0)
        sums = np.stack([kept, np.where(kept, other**2, 0), gain, gain**2]) @ quarters
        n, rate, gained, square = np.column_stack([sums, sums.sum(axis=1)])
        rate, gained, square = np.array([rate, gained, square]) / np.maximum(n, 1)
        error = np.sqrt(np.maximum(square - gained**2, 0) / np.maximum(n, 1))
        return np.asarray((n >= 20) & (gained > rate / 20 + SURE * error))

    shape, middle = tuple(scale * n for n in X.shape[1:]), _middle(X[0], LIGHT_TILE)
    return Comparison(
        moving, fixed, shape, scale, differences, light.error, lower, middle, LIGHT_APART
    )


def compare_bits(
    moving: int,
    fixed: int,
    Y: list[Array],
    overview: int,
    t: int,
    count: Callable[[Array, int], Array],
) -> Comparison:
    """Return the Comparison of the bitmaps of two gray photographs; its H shift by whole pixels.

    Y are the fixed one's levels, t the threshold of the overview; count(offset, level) returns d of
    a level.
    """
    tile, scale = _middle(Y[overview], BITS_TILE), 2**overview
    signs = np.where(mtb.exclusion(tile, t), np.where(tile > t, 1, -1), np.nan).astype(np.float32)

    def differences(H: F64, pixel: int = scale) -> F64:
        level = min(pixel.bit_length(), len(Y)) - 1
        return np.asarray(count(np.rint(H[1::-1, 2] / 2**level).astype(int), level), np.float64)

    def error(d: F64) -> float:
        differ, compared = d.sum(axis=0)
        return float(differ / compared) if compared else light.ERROR_WITHOUT_OVERLAP

    def lower(d: F64, other: F64) -> Mask:
        d, other = (np.vstack([one, one.sum(axis=0)]) for one in (d, other))
        own, rate = (one[:, 0] / np.maximum(one[:, 1], 1) for one in (d, other))
        return np.asarray(
            rate - own > rate / 20 + SURE * np.sqrt(rate / np.maximum(other[:, 1], 1))
        )

    return Comparison(
        moving, fixed, Y[0].shape, scale, differences, error, lower, signs, BITS_APART
    )


def validate(pair: Comparison, H: F64, *, limit: float = np.inf) -> Validation:
    """Return the Validation of a pair whose search, of up to `limit` pixels, found H.

    The identity takes the place of an H that is not clearly better.
    """
    still, fine, coarse = np.eye(3), max(pair.scale // 2, 1), pair.scale
    before = pair.differences(still, 1)
    after = before if np.array_equal(H, still) else pair.differences(H, 1)
    if pair.error(before) < light.ERROR_WITHOUT_OVERLAP and not pair.lower(after, before)[-1]:
        H, after = still, before
    d = pair.differences(H, fine)
    near = [pair.differences(shift(H, NEAR * fine * to), fine) for to in EIGHT]
    elsewhere = [pair.error(pair.differences(shift(H, FAR * coarse * to))) for to in EIGHT]
    if (e := pair.error(after)) == light.ERROR_WITHOUT_OVERLAP or not any(
        elsewhere + [pair.error(one) for one in near]
    ):
        return uninformative(pair.moving, pair.fixed)
    middle = (np.array(pair.shape[::-1]) - 1) / 2
    dx, dy = (float(by) for by in warp.apply(H, [middle])[0] - middle)
    degrees = float(np.rad2deg(np.arctan2(H[1, 0], H[0, 0])))
    sure = confidence(pair.error(pair.differences(H)), elsewhere)
    away = int(np.any([pair.lower(one, d)[:-1] for one in near], axis=0).sum())
    reason = failure_reason(pair, H, elsewhere, all(pair.lower(d, one)[-1] for one in near), away)
    if max(abs(dx), abs(dy)) >= limit:
        reason = f"the offset lies at the end of the range, {limit} pixels"
    apart = (
        away >= ROTATED
        if sure >= LOST
        else pair.error(pair.differences(still, 8 * coarse)) > pair.apart
    )
    numbers = (dy, dx), degrees, pair.error(before), e, sure
    return Validation(pair.moving, pair.fixed, H, *numbers, True, reason, apart)


def uninformative(moving: int, fixed: int) -> Validation:
    """Return the Validation of a pair that cannot be compared."""
    reason = (
        "uninformative: both measure too little of the scene, or no threshold divides both pictures"
    )
    return Validation(moving, fixed, np.eye(3), (0.0, 0.0), 0.0, 0.0, 0.0, 0.0, False, reason)


def failure_reason(pair: Comparison, H: F64, elsewhere: list[float], clear: bool, away: int) -> str:
    """Return why not to trust H, or "", by errors `elsewhere`, worse ones near it, quarters better `away`."""
    e, n = pair.error(pair.differences(H)), pair.scale
    if not any(elsewhere):
        return f"the picture repeats itself: {FAR * n} pixels away the photographs fit as well"
    if (sure := confidence(e, elsewhere)) < LOST:
        return f"{FAR * n} pixels away the photographs fit nearly as well (confidence {sure:.2f})"
    if away:
        return (
            f"{away} of 4 quarters of the picture fit better elsewhere (rotation, depth or motion)"
        )
    if not clear:
        return f"{NEAR * max(n // 2, 1)} pixels away the photographs fit as well"
    for rival in rivals(pair.middle):
        also = pair.error(pair.differences(shift(H, rival * n)))
        if confidence(e, [also]) < LOST or also - e < ALIKE * (np.mean(elsewhere) - e):
            on = tuple((rival * n).tolist())
            return f"the picture repeats itself: moved on by {on} it fits nearly as well"
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
    """Return the shifts at which a picture resembles itself most: peaks of its autocorrelation, by half."""
    (h, w), kept, r = middle.shape, np.isfinite(middle), round(4 * light.LOCAL_MEAN_SIGMA)
    k = np.exp(-0.5 * (np.arange(-r, r + 1) / light.LOCAL_MEAN_SIGMA) ** 2)
    down, across = (blur.blur_matrix(n, k / k.sum()) for n in (h, w))
    total, share = (
        down @ one @ across for one in (np.where(kept, middle, 0), kept)
    )  # `light.local_mean`
    x = np.where(kept, middle - total / np.maximum(share, 1e-6), 0)
    c = np.fft.fftshift(np.fft.irfft2(np.abs(np.fft.rfft2(x, (2 * h, 2 * w))) ** 2)[:, :w], axes=0)
    near = np.max(
        [np.pad(c, 2, "edge")[j : j + 2 * h] for j in range(5)], axis=0
    )  # of 5 x 5: of rows, then
    near = np.max([near[:, j : j + w] for j in range(5)], axis=0)
    y, x = np.nonzero((c == near) & (c > 0))
    found = np.stack([y - h, x], axis=-1)[np.argsort(-c[y, x], kind="stable")[: RIVALS + 1]]
    return [shift for shift in found if np.abs(shift).max() > NEAR]


def shift(H: F64, offset: ArrayLike) -> F64:
    """Return H, and then an offset (dy, dx) further."""
    dy, dx = np.asarray(offset, float)
    return np.asarray(np.array([[1, 0, dx], [0, 1, dy], [0, 0, 1]]) @ H)


def _middle(image: Array, side: int) -> Array:
    """Return the middle of a picture (H, W), of this side at most."""
    rows, columns = (
        slice(max(n - side, 0) // 2, max(n - side, 0) // 2 + side) for n in image.shape
    )
    return image[rows, columns]
