"""Can an alignment be trusted? A search always gives an answer, so the answer is checked.

H        homography          (3, 3): where pixel (x, y, 1) of the moving photo lies on the fixed one
p        pixels              (n, 2) at which light is compared, on an even grid over an overview of at most
                             half a megapixel; bitmaps with offset 0 are also compared at full
                             resolution
d        differences         of light (n,), relative to it, NaN where one photo measures none; of bitmaps
                             (4, 2): in each quarter of the image the bits that differ, and those
                             compared
e        error               mean of d^2, see `align.light`; bits that differ / bits compared
near     differences 2 pixels further than H, in eight directions
far      differences 8 pixels further

84 % of Ward's brackets came out well; in the others the camera was rotated or moved too far, or the
scene was all fine texture. So the questions are: Is H better than the identity? Is it better than
what lies around it? Do the four quarters of the image agree? (In a rotation each of them moves in
another direction.) Does a repeating texture fit elsewhere as well?
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from hdrlab.align import homography, light, mtb
from hdrlab.core.arrays import F32, F64, Array, ArrayLike, Mask
from hdrlab.core.filters import blur, warp
from hdrlab.diagnostics.warning_texts import MARGIN

# pixels of the overview; distances at which other offsets are compared
NEAR_PIXELS = 2
FAR_PIXELS = 8
# standard errors by which an error is clearly lower
MIN_GAIN_SIGMAS = 3
# relative gain by which an error is clearly lower
MIN_RELATIVE_GAIN = 1 / 20
# pixels of a quarter that must be compared
MIN_COMPARED_PIXELS = 20
# confidence below which an alignment is not known; wrong ones stay below 0.1, right ones reach 0.6
# and more
MIN_CONFIDENCE = 0.3
# shifts at which a texture resembles itself most
RIVAL_COUNT = 4
# A rival fits as well if its error is that close to the best one, relative to the error elsewhere.
MAX_RIVAL_LOSS = 0.1
# pixels; side of the part of a bitmap, or of light, in which rivals are searched
BITS_TILE = 64
LIGHT_TILE = 512
# error of photos that are clearly not aligned, of bits and of light; it is taken at an eighth of
# the resolution, where there is no noise
MAX_ALIGNED_BITS_ERROR = 0.1
MAX_ALIGNED_LIGHT_ERROR = 0.1
# If that many quarters of an image fit better elsewhere, the camera was rotated; if fewer,
# something moved.
MIN_ROTATED_QUARTERS = 3
DIRECTIONS = np.array([(dy, dx) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if dy or dx])


@dataclass(frozen=True, kw_only=True, eq=False)
class Validation:
    """The result of comparing two photos after an alignment.

    Attributes
    ----------
    moving, fixed : int
        Indices of the photos; they are neighbors in brightness, and the darker one moves.
    H : (3, 3)
        Where pixel (x, y, 1) of `moving` lies on `fixed`.
    offset : (float, float)
        (dy, dx) in pixels, by which the center of `moving` is shifted.
    degrees : float
        Rotation, clockwise as seen.
    before, after : float
        Error without the alignment and with it.
    confidence : float
        1 is a perfect match, 0 is no better than 8 pixels away.
    informative : bool
        False if the photos cannot be compared.
    failure : str
        The reason not to trust H; "" if there is none.
    apart : bool
        Whether the photos are clearly not aligned, wherever H puts them.
    confirmed : bool, optional
        Whether the light of the photos confirms `step`; None if that was not checked, or if too few
        pixels are well exposed in both photos.
    is_borderline : bool
        Whether the photos are misaligned by so little evidence that they may as well be aligned.
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
    confirmed: bool | None = None
    is_borderline: bool = False

    @property
    def reliable(self) -> bool:
        """Whether no reason was found not to trust H."""
        return not self.failure

    @property
    def is_misaligned(self) -> bool:
        """Whether the photos are clearly not aligned, or light does not confirm that they are."""
        return self.apart or self.confirmed is False

    @property
    def known(self) -> bool:
        """Whether H is clearly better than what lies around it, or confirmed by light."""
        return bool(self.confirmed) or self.confidence >= MIN_CONFIDENCE

    @property
    def step(self) -> F64:
        """H where it is known; else the identity, so that a photo stays with its neighbor."""
        return self.H if self.known else np.eye(3)


@dataclass(frozen=True, kw_only=True, eq=False)
class Comparison:
    """Two photos that can be compared after any H.

    Attributes
    ----------
    moving, fixed : int
        Indices of the photos.
    shape : tuple of int
        Size of the fixed photo.
    scale : int
        Pixels of the photo in one pixel of the overview.
    differences : function of H, or of H and the pixels of the photo in one pixel
        It returns d, of the overview or of that size.
    error : function of d
        It returns e, and `light.ERROR_WITHOUT_OVERLAP` if the photos have too little in common.
    lower : function of two d, and optionally of a margin
        It returns (5,) bool: whether the first is clearly lower in each quarter, and in the whole
        image. The margin multiplies the difference that is needed.
    middle : (h, w)
        The middle of the fixed photo, NaN where it measures nothing.
    max_aligned_error : float
        Photos with a larger error are clearly not aligned.
    """

    moving: int
    fixed: int
    shape: tuple[int, ...]
    scale: int
    differences: Callable[..., F64]
    error: Callable[[F64], float]
    lower: Callable[..., Mask]
    middle: F32
    max_aligned_error: float


def compare_light(moving: int, fixed: int, X: F32, scale: int = 1) -> Comparison:
    """Return the Comparison of light X (2, h, w), in which the gain of an H is measured pixel by pixel.

    `scale` is the number of pixels of the photo in one pixel of X.
    """
    points = light.lattice(X.shape[1:])
    is_right, is_low = (points > points.max(axis=0) / 2).T
    quarters = np.eye(4, dtype=np.float32)[is_right + 2 * is_low]

    def differences(H: F64, pixel: int = scale) -> F64:
        return light.differences(X, homography.enlarge(H, 1 / scale), points)

    def lower(d: F64, other: F64, margin: float = 1.0) -> Mask:
        gain = other**2 - d**2
        is_known = np.isfinite(gain)
        gain = np.where(is_known, gain, 0)
        other_squared = np.where(is_known, other**2, 0)
        sums = np.stack([is_known, other_squared, gain, gain**2]) @ quarters
        count, *totals = np.column_stack([sums, sums.sum(axis=1)])
        other_mean, gain_mean, gain_square_mean = np.array(totals) / np.maximum(count, 1)
        variance = np.maximum(gain_square_mean - gain_mean**2, 0)
        standard_error = np.sqrt(variance / np.maximum(count, 1))
        needed = other_mean * MIN_RELATIVE_GAIN + MIN_GAIN_SIGMAS * standard_error
        return np.asarray((count >= MIN_COMPARED_PIXELS) & (gain_mean > margin * needed))

    return Comparison(
        moving=moving,
        fixed=fixed,
        shape=tuple(scale * n for n in X.shape[1:]),
        scale=scale,
        differences=differences,
        error=light.error,
        lower=lower,
        middle=_middle(X[0], LIGHT_TILE),
        max_aligned_error=MAX_ALIGNED_LIGHT_ERROR,
    )


def compare_bits(
    moving: int,
    fixed: int,
    Y: list[Array],
    overview: int,
    t: int,
    count: Callable[[Array, int], Array],
) -> Comparison:
    """Return the Comparison of the bitmaps of two gray photos, whose H shift by whole pixels.

    Y is the pyramid of the fixed photo, t the threshold of the overview; count(offset, level)
    returns d of a level of the pyramid.
    """
    tile = _middle(Y[overview], BITS_TILE)
    scale = 2**overview
    signs = np.where(mtb.exclusion(tile, t), np.where(tile > t, 1, -1), np.nan)

    def differences(H: F64, pixel: int = scale) -> F64:
        level = min(pixel.bit_length(), len(Y)) - 1
        offset = np.rint(H[1::-1, 2] / 2**level).astype(int)
        return np.asarray(count(offset, level), np.float64)

    def error(d: F64) -> float:
        differing, compared = d.sum(axis=0)
        return float(differing / compared) if compared else light.ERROR_WITHOUT_OVERLAP

    def lower(d: F64, other: F64, margin: float = 1.0) -> Mask:
        d = np.vstack([d, d.sum(axis=0)])
        other = np.vstack([other, other.sum(axis=0)])
        d_rate = d[:, 0] / np.maximum(d[:, 1], 1)
        other_rate = other[:, 0] / np.maximum(other[:, 1], 1)
        standard_error = np.sqrt(other_rate / np.maximum(other[:, 1], 1))
        needed = other_rate * MIN_RELATIVE_GAIN + MIN_GAIN_SIGMAS * standard_error
        return np.asarray(other_rate - d_rate > margin * needed)

    return Comparison(
        moving=moving,
        fixed=fixed,
        shape=Y[0].shape,
        scale=scale,
        differences=differences,
        error=error,
        lower=lower,
        middle=signs.astype(np.float32),
        max_aligned_error=MAX_ALIGNED_BITS_ERROR,
    )


def validate(pair: Comparison, H: F64, *, limit: float = np.inf) -> Validation:
    """Return the Validation of a pair for which a search, of up to `limit` pixels, found H.

    The identity replaces an H that is not clearly better.
    """
    identity = np.eye(3)
    fine = max(pair.scale // 2, 1)
    coarse = pair.scale
    before = pair.differences(identity, 1)
    after = before if np.array_equal(H, identity) else pair.differences(H, 1)
    if pair.error(before) < light.ERROR_WITHOUT_OVERLAP and not pair.lower(after, before)[-1]:
        H = identity
        after = before
    d = pair.differences(H, fine)
    near = [
        pair.differences(shift(H, NEAR_PIXELS * fine * direction), fine) for direction in DIRECTIONS
    ]
    elsewhere = [
        pair.error(pair.differences(shift(H, FAR_PIXELS * coarse * direction)))
        for direction in DIRECTIONS
    ]
    error = pair.error(after)
    all_fit = not any(elsewhere + [pair.error(other) for other in near])
    if error == light.ERROR_WITHOUT_OVERLAP or all_fit:
        return uninformative(pair.moving, pair.fixed)
    sure = confidence(pair.error(pair.differences(H)), elsewhere)

    def count_better_quarters(margin: float) -> int:
        is_better = [pair.lower(other, d, margin)[:-1] for other in near]
        return int(np.any(is_better, axis=0).sum())

    better_count = count_better_quarters(1.0)
    is_best_nearby = all(pair.lower(d, other)[-1] for other in near)
    center = (np.array(pair.shape[::-1]) - 1) / 2
    dx, dy = warp.apply(H, [center])[0] - center
    reason = failure_reason(pair, H, elsewhere, is_best_nearby, better_count)
    if max(abs(dx), abs(dy)) >= limit:
        reason = f"the offset is at the end of the search range, {limit} pixels"
    is_clearly_apart = True
    apart = False
    if sure >= MIN_CONFIDENCE / MARGIN:
        is_clearly_apart &= count_better_quarters(MARGIN) >= MIN_ROTATED_QUARTERS
        apart = better_count >= MIN_ROTATED_QUARTERS
    if sure < MIN_CONFIDENCE * MARGIN:
        error_in_place = pair.error(pair.differences(identity, 8 * coarse))
        is_clearly_apart &= error_in_place > MARGIN * pair.max_aligned_error
        if sure < MIN_CONFIDENCE:
            apart = error_in_place > pair.max_aligned_error
    return Validation(
        moving=pair.moving,
        fixed=pair.fixed,
        H=H,
        offset=(float(dy), float(dx)),
        degrees=float(np.rad2deg(np.arctan2(H[1, 0], H[0, 0]))),
        before=pair.error(before),
        after=error,
        confidence=sure,
        informative=True,
        failure=reason,
        apart=apart,
        is_borderline=apart and not is_clearly_apart,
    )


def uninformative(moving: int, fixed: int) -> Validation:
    """Return the Validation of a pair that cannot be compared."""
    return Validation(
        moving=moving,
        fixed=fixed,
        H=np.eye(3),
        offset=(0.0, 0.0),
        degrees=0.0,
        before=0.0,
        after=0.0,
        confidence=0.0,
        informative=False,
        failure="uninformative: the two photos show too little of the scene in common, or no "
        "threshold divides both",
    )


def failure_reason(
    pair: Comparison, H: F64, elsewhere: list[float], is_best_nearby: bool, better_count: int
) -> str:
    """Return why not to trust H, or "".

    Parameters
    ----------
    pair : Comparison
    H : (3, 3)
    elsewhere : list of float
        Errors at FAR_PIXELS pixels of the overview from H.
    is_best_nearby : bool
        Whether H is clearly better than all offsets NEAR_PIXELS it.
    better_count : int
        How many quarters of the image are clearly better elsewhere.
    """
    error = pair.error(pair.differences(H))
    far = FAR_PIXELS * pair.scale
    if not any(elsewhere):
        return f"the image repeats itself: {far} pixels away the photos fit as well"
    sure = confidence(error, elsewhere)
    if sure < MIN_CONFIDENCE:
        return f"{far} pixels away the photos fit nearly as well (confidence {sure:.2f})"
    if better_count:
        return (
            f"{better_count} of 4 quarters of the image fit better elsewhere (rotation, depth or "
            "motion)"
        )
    if not is_best_nearby:
        near = NEAR_PIXELS * max(pair.scale // 2, 1)
        return f"{near} pixels away the photos fit as well"
    mean_elsewhere = np.mean(elsewhere)
    for rival in rivals(pair.middle):
        offset = rival * pair.scale
        rival_error = pair.error(pair.differences(shift(H, offset)))
        is_alike = rival_error - error < MAX_RIVAL_LOSS * (mean_elsewhere - error)
        if confidence(error, [rival_error]) < MIN_CONFIDENCE or is_alike:
            shifted = tuple(offset.tolist())
            return f"the image repeats itself: shifted by {shifted} it fits nearly as well"
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
    """Return the shifts at which an image resembles itself most: peaks of its autocorrelation.

    Of each two opposite shifts there is one.
    """
    height, width = middle.shape
    is_known = np.isfinite(middle)
    detail = _subtract_local_mean(middle, is_known)
    spectrum = np.abs(np.fft.rfft2(detail, (2 * height, 2 * width))) ** 2
    correlation = np.fft.fftshift(np.fft.irfft2(spectrum)[:, :width], axes=0)
    # The maximum of 5 x 5 values around each one: of rows first, then of columns.
    padded = np.pad(correlation, 2, "edge")
    row_maximum = np.max([padded[j : j + 2 * height] for j in range(5)], axis=0)
    maximum = np.max([row_maximum[:, j : j + width] for j in range(5)], axis=0)
    y, x = np.nonzero((correlation == maximum) & (correlation > 0))
    strongest = np.argsort(-correlation[y, x], kind="stable")[: RIVAL_COUNT + 1]
    shifts = np.stack([y - height, x], axis=-1)[strongest]
    return [shift for shift in shifts if np.abs(shift).max() > NEAR_PIXELS]


def _subtract_local_mean(image: F32, is_known: Mask) -> F64:
    """Return an image minus the mean around each pixel (`light.local_mean`); 0 where unknown."""
    radius = round(4 * light.LOCAL_MEAN_SIGMA)
    kernel = np.exp(-0.5 * (np.arange(-radius, radius + 1) / light.LOCAL_MEAN_SIGMA) ** 2)
    kernel /= kernel.sum()
    blur_rows = blur.blur_matrix(image.shape[0], kernel)
    blur_columns = blur.blur_matrix(image.shape[1], kernel)
    total = blur_rows @ np.where(is_known, image, 0) @ blur_columns
    weight = blur_rows @ is_known @ blur_columns
    return np.where(is_known, image - total / np.maximum(weight, 1e-6), 0)


def shift(H: F64, offset: ArrayLike) -> F64:
    """Return H followed by a shift by an offset (dy, dx)."""
    dy, dx = np.asarray(offset, float)
    return np.asarray(np.array([[1, 0, dx], [0, 1, dy], [0, 0, 1]]) @ H)


def _middle(image: Array, side: int) -> Array:
    """Return the middle of an image (H, W), at most `side` pixels wide and high."""
    top = max(image.shape[0] - side, 0) // 2
    left = max(image.shape[1] - side, 0) // 2
    return image[top : top + side, left : left + side]
