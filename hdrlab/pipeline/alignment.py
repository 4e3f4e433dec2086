"""Align a bracket pair by pair, and validate each result.

"mtb" shifts by whole pixels. So does "auto", but it checks each pair by light: where the photos are
still displaced by more than MAX_DISPLACEMENT pixels, it shifts by fractions of pixels and rotates, see
`pipeline.rigid_motion` and `pipeline.tile_motion`. Where that does not align a pair either, it tries
"cerman", and then "homography". Both report a pair that light does not confirm.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise, starmap
from typing import Any

import numpy as np

from hdrlab.align import cerman, homography, light, mtb
from hdrlab.core import colour, steps, transfer
from hdrlab.core.arrays import F32, F64, Array, ArrayLike, as_stack, as_table, as_times, levels
from hdrlab.core.choices import require_choice
from hdrlab.core.filters import warp
from hdrlab.core.threads import map_in_threads
from hdrlab.diagnostics import registration as validation
from hdrlab.diagnostics.registration import Validation
from hdrlab.fast.mtb import Photograph
from hdrlab.pipeline import catalogue, rigid_motion, tile_motion
from hdrlab.pipeline.rigid_motion import Fit

METHODS = ("auto", *catalogue.names("align"))
# The methods that compare light, from the simplest to the most general.
SEARCHES: dict[str, Callable[[list[F32]], Iterator[Any]]] = {
    "cerman": cerman.search,
    "homography": homography.search,
}
# The methods that "auto" may need, from the most general to the simplest.
MOST_GENERAL_FIRST = ("homography", "cerman", "rotation", "mtb")
# Levels of an image pyramid: more than any image has, so the range of the search grows with the
# image.
PYRAMID_LEVELS = 16
# percentiles of Ward's threshold that are tried if the search with the median fails
OTHER_PERCENTILES = (0.83, 0.17)
# Results with these percentiles need a higher confidence.
MIN_OTHER_CONFIDENCE = 0.9
# Whole pixels are good enough if 95 % of the image is displaced by no more than this.
MAX_DISPLACEMENT = 0.3
# Pixels by which light may shift the middle of the image against what bitmaps are certain of. A
# rotation that they overlook hardly moves the middle.
MAX_MIDDLE_SHIFT = 3
# A first, quick step that is no longer than this needs no closer look; it falls short of the
# displacement by up to a quarter.
MAX_QUICK_DISPLACEMENT = 0.2
# A motion is found if a next step moves 95 % of the image by no more than so many pixels.
MAX_REMAINING_DISPLACEMENT = 0.1
# A fraction of a pixel is worth the resampling if it leaves no more than this of the shifts of blocks.
# With true motions 0.03 to 0.2 remains. Photos from a tripod, in which blocks want to move in
# different directions, keep 0.5 to 1.4.
MAX_REMAINING_FRACTION = 0.25

# A response, or a function that finds it when light is compared.
Curve = ArrayLike | Callable[[], F64 | None] | None
# From the indices and the gray images of a darker and a brighter photo to the pyramid of their
# light.
MakePyramid = Callable[[int, int, Array, Array], list[F32]]


@dataclass(frozen=True, kw_only=True, eq=False)
class Registration:
    """The alignment of a bracket.

    Attributes
    ----------
    homographies : (P, 3, 3)
    pairs : tuple of Validation
        One for each pair of neighbors, from dark to bright.
    method : str
        With "auto", the most general method that a pair needed; "none" if all photos stay in place.
    """

    homographies: F64
    pairs: tuple[Validation, ...]
    method: str


def register(
    images: ArrayLike, method: str = "auto", *, times: ArrayLike | None = None, g: Curve = None
) -> Registration:
    """Align photos by a method of METHODS, and validate the alignment of each pair.

    A pair's homography is accepted only if the photos then agree clearly better than without it.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3), uint8 or uint16
        Photos of one scene with different exposures, in any order.
    method : str
        "mtb", "cerman", "homography", or "auto": "mtb", and the others for pairs that no shift
        aligns.
    times : (P,) float, optional
        Exposure times in seconds. Without them, exposure ratios come from the histograms.
    g : (n,) or (n, 3) float, or function, optional
        The camera's response, ln exposure of each pixel value, or a function that finds it when
        light is compared. Without it, the histograms of each pair are matched.

    Raises
    ------
    InputError
        If images is not a stack of photos, or times or the response do not fit them.

    Examples
    --------
    >>> from hdrlab import scenes
    >>> from hdrlab.capture import camera, responses
    >>> taken = camera.shoot(scenes.room((120, 180)), [0.02, 0.08], offsets=[[3, -4], [0, 0]])
    >>> found = register(taken.images, times=taken.times, g=responses.true_g())
    >>> found.method, found.homographies[0, :2, 2].tolist()  # dx, dy
    ('mtb', [-4.0, 3.0])
    """
    images = as_stack(images)
    require_choice("align", method, METHODS)
    make_pyramid = pyramid_maker(images, times, g)
    if method in SEARCHES:
        pairs = tuple(register_by_light(images, make_pyramid, method))
    elif method == "auto":
        results = list(starmap(partial(align_pair, make_pyramid), photograph_pairs(images)))
        pairs = tuple(result.validation for result in results)
        used = {result.method for result in results}
        method = next((name for name in MOST_GENERAL_FIRST if name in used), "none")
    else:
        pairs = tuple(starmap(align_by_shift, photograph_pairs(images)))
    order = [pairs[0].moving, *(pair.fixed for pair in pairs)] if pairs else [0]
    homographies = warp.chain_homographies(order, [pair.step for pair in pairs])
    return Registration(homographies=homographies, pairs=pairs, method=method)


@dataclass(frozen=True, kw_only=True, eq=False)
class PairResult:
    """The Validation of a pair, and the simplest method that aligns it."""

    validation: Validation
    method: str


def align_pair(
    make_pyramid: MakePyramid, moving: int, B: Photograph, fixed: int, A: Photograph
) -> PairResult:
    """Return the PairResult of two photos: shifted by whole pixels if that is enough."""
    first = best_percentile(moving, B, fixed, A)
    method = "mtb" if np.any(first.step != np.eye(3)) else "none"
    shifted = PairResult(validation=first, method=method)
    side = tile_motion.quick_side(A.Y[0].shape)
    quick = tile_motion.check(B.Y[0], A.Y[0], first.step, side)
    if quick.is_confirmed and quick.displacement <= MAX_QUICK_DISPLACEMENT:
        return PairResult(validation=confirm(first, first.step), method=method)
    return improve(shifted, B, A, make_pyramid)


def align_by_shift(moving: int, B: Photograph, fixed: int, A: Photograph) -> Validation:
    """Return the Validation of two photos shifted by whole pixels.

    It is unconfirmed where light shows that the photos do not fit: bitmaps overlook small rotations.
    """
    first = best_percentile(moving, B, fixed, A)
    side = tile_motion.quick_side(A.Y[0].shape)
    if tile_motion.check(B.Y[0], A.Y[0], first.step, side).is_confirmed:
        return first
    level = rigid_motion.finest_level(B.Y, A.Y)
    if level is None:
        return first
    fit = rigid_motion.check(B.Y, A.Y, first.step, level)
    if fit.is_confirmed or not fit.is_usable:
        return first
    return replace(first, confirmed=False, is_borderline=not fit.is_refuted)


def confirm(first: Validation, H: F64) -> Validation:
    """Return the Validation of a pair for which light confirms the homography H."""
    return replace(
        first,
        H=H,
        offset=(float(H[1, 2]), float(H[0, 2])),
        degrees=float(np.rad2deg(np.arctan2(H[1, 0], H[0, 0]))),
        failure="",
        apart=False,
        confirmed=True,
        is_borderline=False,
    )


def photograph_pairs(
    images: Array, bits: int = PYRAMID_LEVELS
) -> Iterator[tuple[int, Photograph, int, Photograph]]:
    """Yield index and Photograph of both neighbors, from dark to bright, with few in memory at a time."""

    def load(image: int) -> tuple[int, Photograph]:
        return image, Photograph(images[image], bits=bits)

    loaded = map_in_threads(load, mtb.by_brightness(images))
    for (moving, B), (fixed, A) in pairwise(loaded):
        yield moving, B, fixed, A


def register_by_light(
    images: Array, make_pyramid: MakePyramid, method: str
) -> Iterator[Validation]:
    """Yield the Validation of each pair from dark to bright, by one of SEARCHES at full resolution."""
    gray = images if images.ndim == 3 else images[..., 1]
    for moving, fixed in pairwise(mtb.by_brightness(images)):
        pyramid = make_pyramid(moving, fixed, gray[moving], gray[fixed])
        comparison = validation.compare_light(moving, fixed, pyramid[0])
        H = steps.last(SEARCHES[method](pyramid)).H
        yield validation.validate(comparison, H)


def improve(
    shifted: PairResult, B: Photograph, A: Photograph, make_pyramid: MakePyramid
) -> PairResult:
    """Return the PairResult of the simplest method that aligns a pair, confirmed by light or not."""
    first = shifted.validation
    level = rigid_motion.finest_level(B.Y, A.Y)
    if level is None:
        return shifted
    # Noise would favor any fraction of a pixel, because interpolation averages it.
    is_noisy = rigid_motion.is_reduced(A.Y, level)
    if is_noisy and rigid_motion.check(B.Y, A.Y, first.step, level).is_confirmed:
        return PairResult(validation=confirm(first, first.step), method=shifted.method)
    found = find_motion(B, A, first.step, level)
    H = found.motion
    rest = rigid_motion.displacement(H @ np.linalg.inv(first.step), A.Y[0].shape)
    if found.is_confirmed and rest <= MAX_DISPLACEMENT:
        return PairResult(validation=confirm(first, first.step), method=shifted.method)
    is_certain = first.reliable and first.confidence > MIN_OTHER_CONFIDENCE
    if is_certain and _measure_middle_shift(H, first.step, A.Y[0].shape) > MAX_MIDDLE_SHIFT:
        return shifted

    if found.is_confirmed and found.scale == 1:
        shift_fit = tile_motion.check(B.Y[0], A.Y[0], first.step, tile_motion.SIDE_PIXELS)
        if found.median_shift < MAX_REMAINING_FRACTION * shift_fit.median_shift:
            return PairResult(validation=confirm(first, H), method="rotation")
        if shift_fit.is_confirmed:
            return PairResult(validation=confirm(first, first.step), method=shifted.method)
    in_place = rigid_motion.check(B.Y, A.Y, np.eye(3), level)
    if not found.is_confirmed and not (found.is_usable or in_place.is_usable):
        return shifted  # nearly black or white photos, in which there is nothing to search for
    X = rigid_motion.common_light(B.Y, A.Y, H, level)
    comparison = validation.compare_light(first.moving, first.fixed, X, 2**level)
    if found.is_confirmed:
        gains = comparison.lower(comparison.differences(H), comparison.differences(first.step))
        if gains[-1]:
            return PairResult(validation=confirm(first, H), method="rotation")
        if rigid_motion.check(B.Y, A.Y, first.step, level).is_confirmed:
            return PairResult(validation=confirm(first, first.step), method=shifted.method)
    best = shifted
    best_differences = comparison.differences(first.step)
    scale = 2**A.overview
    pyramid = make_pyramid(first.moving, first.fixed, B.Y[A.overview], A.Y[A.overview])
    for method in ("rotation", *SEARCHES):
        if method != "rotation":
            H = homography.enlarge(steps.last(SEARCHES[method](pyramid)).H, scale)
        other = validation.validate(comparison, H)
        differences = comparison.differences(other.H)
        overlaps = max(map(abs, other.offset)) < min(B.Y[0].shape) / 2
        if other.known and overlaps and comparison.lower(differences, best_differences)[-1]:
            best = PairResult(validation=other, method=method)
            best_differences = differences
        if rigid_motion.check(B.Y, A.Y, best.validation.step, level).is_confirmed:
            return PairResult(
                validation=confirm(best.validation, best.validation.step), method=best.method
            )
    if is_certain:
        return shifted  # the bitmaps are certain, and light shows nothing that fits
    # A coarse level averages black and white pixels to gray ones, which seem to be well exposed.
    H = best.validation.step
    tiles = tile_motion.check(B.Y[0], A.Y[0], H, tile_motion.SIDE_PIXELS)
    if not tiles.is_usable:
        return shifted
    if tiles.has_enough_blocks and tiles.is_confirmed and tiles.displacement <= MAX_DISPLACEMENT:
        return PairResult(validation=confirm(best.validation, H), method=best.method)
    fits = [tiles, rigid_motion.check(B.Y, A.Y, H, level)]
    if not found.is_confirmed:
        fits.append(found)
    is_borderline = not all(fit.is_refuted for fit in fits if fit.is_usable)
    unconfirmed = replace(best.validation, confirmed=False, is_borderline=is_borderline)
    return PairResult(validation=unconfirmed, method=best.method)


def find_motion(B: Photograph, A: Photograph, start: F64, level: int) -> Fit:
    """Return the Fit at the rigid motion of two photos, near `start` or else anywhere.

    `level` is the finest level at which structure outweighs noise.
    """
    near = tile_motion.refine(B.Y[0], A.Y[0], start)
    if near.is_confirmed and near.displacement <= MAX_REMAINING_DISPLACEMENT:
        return near
    found = rigid_motion.refine(B.Y, A.Y, start, level)
    if not found.is_confirmed or found.displacement > MAX_REMAINING_DISPLACEMENT:
        found = rigid_motion.search(B.Y, A.Y, [start, np.eye(3)], level)
    if not found.is_confirmed or not level:
        return found
    fine = tile_motion.refine(B.Y[0], A.Y[0], found.motion)
    return fine if fine.is_confirmed else found


def _measure_middle_shift(H: F64, other: F64, shape: tuple[int, ...]) -> float:
    """Return the distance in pixels between the places to which two homographies bring the middle."""
    middle = np.array([[shape[1] / 2, shape[0] / 2]])
    return float(np.linalg.norm(warp.apply(H, middle) - warp.apply(other, middle)))


def best_percentile(moving: int, B: Photograph, fixed: int, A: Photograph) -> Validation:
    """Return the Validation with thresholds at the median, or else at another percentile of Ward's.

    Another percentile counts if its result is certain and lies elsewhere: photos that were rotated
    also fit nearby.
    """
    first = _validate_at_percentile(moving, B, fixed, A, 0.5)
    if first.reliable:
        return first
    for percentile in OTHER_PERCENTILES:
        other = _validate_at_percentile(moving, B, fixed, A, percentile)
        distance = np.max(np.abs(np.subtract(other.offset, first.offset)))
        is_certain = other.reliable and other.confidence > MIN_OTHER_CONFIDENCE
        if is_certain and distance > validation.NEAR_PIXELS:
            return other
    return first


def _validate_at_percentile(
    moving: int, B: Photograph, fixed: int, A: Photograph, near: float
) -> Validation:
    """Return the Validation of a pair whose thresholds are near this percentile."""
    q = mtb.percentile(A.h[0], B.h[0], near=near)
    if q is None:
        return validation.uninformative(moving, fixed)

    def count(offset: Array, level: int) -> Array:
        return B.count_differences(A, (int(offset[0]), int(offset[1])), level, q)

    threshold = A.threshold(q, A.overview)
    comparison = validation.compare_bits(moving, fixed, A.Y, A.overview, threshold, count)
    H = warp.as_homographies([B.offset_onto(A, q)])[0]
    return validation.validate(comparison, H, limit=2 ** len(A.Y) - 1)


def pyramid_maker(images: Array, times: ArrayLike | None, g: Curve) -> MakePyramid:
    """Return the function that brings the light of two photos to one scale, at every size.

    Without a response, the histogram of the darker photo is matched to that of the brighter one,
    both are decoded by the curve of sRGB, and each pixel is divided by the mean around it: errors
    of the curve are the same in both photos, and cancel.
    """
    n = levels(images)
    seconds = None if times is None else as_times(times, len(images))
    get_curve: Callable[[], F64 | None]
    if callable(g):
        get_curve = g
    else:
        fixed_curve = None if g is None else as_table(g, n)

        def get_curve() -> F64 | None:
            return fixed_curve

    def make_pyramid(moving: int, fixed: int, dark: Array, bright: Array) -> list[F32]:
        step = (n - 1) // np.iinfo(dark.dtype).max  # an overview has 8 bits
        curve = get_curve()
        if curve is None:
            f_inv = colour.decode_srgb(np.arange(n) / (n - 1))[::step]
            return _pair_by_histograms(dark, bright, f_inv)
        channels = as_table(curve, n).reshape(n, -1)
        green = channels[:, min(1, channels.shape[1] - 1)]  # the only channel of a gray image
        f_inv = np.exp(green)[::step]
        ratio = light.exposure_ratio(dark, bright, np.log(f_inv))
        if seconds is not None:
            ratio = seconds[fixed] / seconds[moving]
        return light.pair(bright, dark, f_inv, ratio * f_inv)

    return make_pyramid


def _pair_by_histograms(dark: Array, bright: Array, f_inv: F64) -> list[F32]:
    """Return the pyramid of the light of two photos, relative to its mean around each pixel."""
    T = transfer.brightness_transfer(*transfer.histograms([dark, bright])[0])
    T[0] = 0
    T[-1] = len(f_inv) - 1
    z = np.arange(len(f_inv))
    known = np.flatnonzero(np.isfinite(T))
    matched = np.interp(np.interp(z, known, T[known]), z, f_inv)
    pyramid = light.pair(bright, dark, f_inv, matched)
    return [np.stack([x / light.local_mean(x) for x in X]) for X in pyramid]
