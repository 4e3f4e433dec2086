"""May I trust an alignment? A search always answers, so its answer is compared once more, at full resolution.

H        homography          (3, 3): where pixel (x, y, 1) of the moving photograph lies on the fixed one
p        pixels              (n, 2): those that are compared, spread evenly
d        differences         (n,): of bitmaps 0 or 1, of light relative to it; NaN where one measures none
e        error               mean of d^2, see `align.light`
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
from hdrlab.core.types import F32, F64, Array

# pixels: the distances at which other answers are compared
NEAR, FAR = 2, 8
# confidence below which an answer is lost; wrong ones stay below 0.1, and right ones come to 0.6 and more
LOST = 0.3
# shifts at which a texture resembles itself most
RIVALS = 4
# of the way up to the error elsewhere: a rival this low fits as well
ALIKE = 0.1
# pixels of a bitmap and of light: in this large a part of the picture, its middle, rivals are looked for
BITS_TILE, LIGHT_TILE = 96, 512
# pixels at which bitmaps are compared
BITS = 20_000
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
    quarters : (n, 4), 1 where a pixel of p lies in a quarter of the picture
    differences : function of H that returns d at the pixels p
    middle : (h, w), the middle of the fixed photograph, NaN where it measures nothing
    """

    moving: int
    fixed: int
    shape: tuple[int, ...]
    quarters: F32
    differences: Callable[[F64], F64]
    middle: F32


def compare_light(moving: int, fixed: int, X: F32) -> Comparison:
    """Return the Comparison of light X (2, H, W)."""
    p = light.lattice(X.shape[1:])
    middle = _middle(X[0], LIGHT_TILE)
    return Comparison(moving, fixed, X.shape[1:], _quarters(p), lambda H: light.differences(X, H, p), middle)


def compare_bits(moving: int, fixed: int, Y: Sequence[Array], t: Sequence[int]) -> Comparison:
    """Return the Comparison of the bitmaps of two gray photographs, the fixed one first, by thresholds t.

    Its H shift by whole pixels.
    """
    h, w = Y[0].shape
    x = np.arange(0, w, 2 if h * w > BITS else 1)  # dense along rows, which the processor's cache holds
    y = np.arange(0, h, max(1, round(h * len(x) / BITS)))
    p, z = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2), np.arange(256)
    codes = [np.where(exclusion(z, level), z > level, 2).astype(np.uint8) for level in t]
    a = 3 * codes[0].take(Y[0][y][:, x])
    xor = np.array([0, 1, np.nan, 1, 0, np.nan, np.nan, np.nan, np.nan], np.float32)

    def differences(H: F64) -> F64:
        u, v = x - round(H[0, 2]), y - round(H[1, 2])
        b = Y[1].take(v, axis=0, mode="clip").take(u, axis=1, mode="clip")
        d = xor.take(a + codes[1].take(b))
        d[(v < 0) | (v >= h)] = d[:, (u < 0) | (u >= w)] = np.nan
        return d.ravel()

    tile = _middle(Y[0], BITS_TILE)
    signs = np.where(exclusion(tile, t[0]), np.where(tile > t[0], 1, -1), np.nan).astype(np.float32)
    return Comparison(moving, fixed, (h, w), _quarters(p), differences, signs)


def validate(pair: Comparison, H: F64, *, limit: float = np.inf) -> Validation:
    """Return the Validation of a pair whose search, of up to `limit` pixels, found H.

    The identity takes the place of an H that is not clearly better.
    """
    before, d = pair.differences(np.eye(3)), pair.differences(H)
    if np.isfinite(before).any() and not clearly_lower(gains(pair, d, before).sum(axis=1)):
        H, d = np.eye(3), before
    near, far = ([pair.differences(shift(H, n * step)) for step in EIGHT] for n in (NEAR, FAR))
    errors, elsewhere = (light.error(before), light.error(d)), [light.error(one) for one in far]
    if np.isfinite(d).mean() <= light.LEAST or not _differ(near + far):
        return uninformative(pair.moving, pair.fixed, H)
    sure = confidence(errors[1], elsewhere)
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
    if not _differ(far):
        return f"the picture repeats itself: {FAR} pixels away the photographs fit as well"
    e, elsewhere = light.error(d), [light.error(one) for one in far]
    if (sure := confidence(e, elsewhere)) < LOST:
        return f"8 pixels away the photographs fit nearly as well (confidence {sure:.2f})"
    nearby = np.array([gains(pair, d, other) for other in near])
    if not all(clearly_lower(one) for one in nearby.sum(axis=2)):
        return "2 pixels away the photographs fit as well"
    back = nearby[:, [0, 2, 1, 3, 4]] * np.array([1, 1, 1, -1, 1])[:, None]  # the other's gain over H
    if away := sum(any(clearly_lower(one) for one in quarter) for quarter in np.moveaxis(back, 2, 0)):
        return f"{away} of 4 quarters of the picture fit better elsewhere (rotation, depth or motion)"
    for rival in rivals(pair.middle):
        also = light.error(pair.differences(shift(H, rival)))
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


def gains(pair: Comparison, d: F64, other: F64) -> F64:
    """Return (5, 4), of each quarter: the number compared, sums of d^2, other^2, the gain and its square."""
    gain = other**2 - d**2
    kept = np.isfinite(gain)
    own, gain = np.where(kept, d**2, 0), np.where(kept, gain, 0)
    return np.asarray(np.stack([kept, own, own + gain, gain, gain**2]) @ pair.quarters, np.float64)


def clearly_lower(sums: F64) -> bool:
    """Return whether d's error is lower by a twentieth of the other and two standard errors of the gain."""
    if sums[0] < 20:
        return False
    _, _, rate, gain, square = sums / sums[0]
    return bool(gain > rate / 20 + 2 * np.sqrt(max(square - gain**2, 0) / sums[0]))


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


def _quarters(p: F64) -> F32:
    """Return (n, 4), 1 where a pixel lies in a quarter of the picture."""
    right, low = (p > p.max(axis=0) / 2).T
    return np.eye(4, dtype=np.float32)[right + 2 * low]


def _differ(every: list[F64]) -> bool:
    """Return whether there is any difference at all."""
    return any(bool(np.any(np.abs(d) > 0)) for d in every)


def _middle(image: Array, side: int) -> Array:
    """Return the middle of a picture (H, W), of this side at most."""
    rows, columns = (slice(max(n - side, 0) // 2, max(n - side, 0) // 2 + side) for n in image.shape)
    return image[rows, columns]
