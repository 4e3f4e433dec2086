"""May I trust an alignment? A search always answers, so its answer is compared once more, at full resolution.

H        homography          (3, 3): where pixel (x, y, 1) of the moving photograph lies on the fixed one
p        pixels              (n, 2): those that are compared
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

from hdrlab.align import light
from hdrlab.align.cerman import correlation, peaks
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
BITS_TILE, LIGHT_TILE = 128, 512
# pixels at which bitmaps are compared
BITS = 40_000
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
    """Two photographs, ready to be compared after any H: their d at the pixels p, and the middle of one."""

    moving: int
    fixed: int
    shape: tuple[int, ...]
    p: F64
    differences: Callable[[F64], F64]
    middle: F32  # (h, w), of the fixed photograph, NaN where it measures nothing


def compare_light(moving: int, fixed: int, X: F32) -> Comparison:
    """Return the Comparison of light X (2, H, W)."""
    p = light.lattice(X.shape[1:])
    return Comparison(
        moving, fixed, X.shape[1:], p, lambda H: light.differences(X, H, p), _middle(X[0], LIGHT_TILE)
    )


def compare_bits(moving: int, fixed: int, Y: Sequence[Array], t: Sequence[int]) -> Comparison:
    """Return the Comparison of the bitmaps of two gray photographs, the fixed one first, by thresholds t."""
    p, (h, w) = light.lattice(Y[0].shape, BITS), Y[0].shape
    x, y = p.astype(int).T
    a = Y[0][y, x]

    def differences(H: F64) -> F64:
        u, v = np.rint(warp.apply(np.linalg.inv(H), p)).astype(int).T
        inside = (u >= 0) & (u < w) & (v >= 0) & (v < h)
        b = Y[1][v.clip(0, h - 1), u.clip(0, w - 1)]
        kept = inside & exclusion(a, t[0]) & exclusion(b, t[1])
        return np.where(kept, (a > t[0]) != (b > t[1]), np.nan)

    tile = _middle(Y[0], BITS_TILE)
    signs = np.where(exclusion(tile, t[0]), np.where(tile > t[0], 1, -1), np.nan).astype(np.float32)
    return Comparison(moving, fixed, (h, w), p, differences, signs)


def validate(pair: Comparison, H: F64, *, limit: float = np.inf) -> Validation:
    """Return the Validation of a pair whose search, of up to `limit` pixels, found H.

    The identity takes the place of an H that is not clearly better.
    """
    before, d = pair.differences(np.eye(3)), pair.differences(H)
    if np.isfinite(before).any() and not clearly_lower(d, before):
        H, d = np.eye(3), before
    near, far = ([pair.differences(shift(H, n * step)) for step in EIGHT] for n in (NEAR, FAR))
    errors, elsewhere = (light.error(before), light.error(d)), [light.error(one) for one in far]
    if np.isfinite(d).mean() <= light.LEAST or not np.any(np.nan_to_num([*near, *far])):
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
    if not np.any(np.nan_to_num(far)):
        return f"the picture repeats itself: {FAR} pixels away the photographs fit as well"
    e, elsewhere = light.error(d), [light.error(one) for one in far]
    if (sure := confidence(e, elsewhere)) < LOST:
        return f"8 pixels away the photographs fit nearly as well (confidence {sure:.2f})"
    if not all(clearly_lower(d, other) for other in near):
        return "2 pixels away the photographs fit as well"
    halves = pair.p > np.median(pair.p, axis=0)
    quarters = [np.all(halves == (right, low), axis=1) for right in (False, True) for low in (False, True)]
    if away := sum(any(clearly_lower(other[one], d[one]) for other in near) for one in quarters):
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


def clearly_lower(d: F64, other: F64) -> bool:
    """Return whether an error is lower by a twentieth of the other and three standard errors of the mean."""
    both = np.isfinite(d) & np.isfinite(other)
    if both.sum() < 20:
        return False
    gain = other[both] ** 2 - d[both] ** 2
    return bool(gain.mean() > np.mean(other[both] ** 2) / 20 + 3 * gain.std() / np.sqrt(len(gain)))


def rivals(middle: F32) -> list[Array]:
    """Return the shifts at which a picture resembles itself most: peaks of its autocorrelation."""
    found = peaks(correlation(np.stack([middle, middle])), RIVALS + 1)
    return [shift for shift in found if np.abs(shift).max() > NEAR]


def shift(H: F64, offset: ArrayLike) -> F64:
    """Return H, and then an offset (dy, dx) further."""
    return np.asarray(warp.as_homographies(np.reshape(offset, (1, 2)))[0] @ H)


def _middle(image: Array, side: int) -> Array:
    """Return the middle of a picture (H, W), of this side at most."""
    rows, columns = (slice(max(n - side, 0) // 2, max(n - side, 0) // 2 + side) for n in image.shape)
    return image[rows, columns]
