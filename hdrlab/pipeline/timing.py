"""Exposure times from the pixels: corrections of stated times, and relative times where there are none.

The histograms of two photos of one scene give their exposure ratio, if the response is known. Here
it is the response of a typical camera: JPEGs are steeper than the curve of sRGB, by a power of 1.3
to 1.5 in three cameras. So these times are right up to a power. `diagnostics.exposure_times` then
refines each of them.
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from hdrlab.align import light, mtb
from hdrlab.core import arrays, colour
from hdrlab.core.bracket import Bracket, bracket as make_bracket
from hdrlab.diagnostics import exposure_times, plausibility
from hdrlab.diagnostics.exposure_times import Estimate
from hdrlab.diagnostics.warning_texts import MARGIN, warning_text
from hdrlab.errors import InputError
from hdrlab.pipeline import recovery
from hdrlab.pipeline.assembly import Assembly, Method, select_photos
from hdrlab.pipeline.checks import MIN_WORTHLESS_STOPS

# stops by the curve of sRGB, for each stop of exposure
TYPICAL_STEEPNESS = 1.4
# stops between the darkest and the brightest photo; less is one exposure
MIN_SPAN_STOPS = 0.3
# stops of spread in held-out pixels that true times leave at most
MAX_CONSISTENT_STOPS = 0.01
# photos whose times are refined; of more, each matters little, and the work grows with their square
MAX_REFINED_PHOTOS = 64
# steps between photos that a sentence lists one by one
MAX_LISTED_STEPS = 12
# photos whose histograms are compared at a time
MAX_RANKED_PHOTOS = 64
# pixels of a photo, on an even grid
MAX_PIXELS = 400_000


def typical_response(n: int, linear: bool = False) -> arrays.F64:
    """Return ln exposure of n pixel values for a typical camera, or for a linear one.

    The value 0 gets the exposure of a quarter of a value.
    """
    z = np.maximum(np.arange(n), 0.25) / (n - 1)
    if linear:
        return np.log(z)
    return np.log(colour.decode_srgb(z)) / TYPICAL_STEEPNESS


def space_by_stops(bracket: Bracket, stops: arrays.ArrayLike) -> Bracket:
    """Return the bracket with relative times, from the darkest to the brightest photo.

    Parameters
    ----------
    bracket : Bracket
        Its times are ignored.
    stops : float or (P - 1,) float
        Stops from each photo to the next brighter one: one number for all, or one for each.

    Examples
    --------
    >>> space_by_stops(make_bracket(np.uint8([[[90]], [[9]]]), [1, 1]), 2).times.tolist()
    [1.0, 4.0]
    """
    images = bracket.images
    if not np.all(np.asarray(stops) >= 0):
        raise InputError(f"expected positive steps between the photographs in stops, got {stops!r}")
    steps = np.broadcast_to(np.asarray(stops, float), (len(images) - 1,))
    times = np.empty(len(images))
    times[mtb.by_brightness(images)] = 2 ** np.cumsum([0, *steps])
    spaced = make_bracket(
        images,
        times,
        bracket.names,
        valid=bracket.valid,
        linear=bracket.linear,
        damaged=bracket.damaged,
    )
    return replace(spaced, has_relative_times=True)


def estimate_relative_times(bracket: Bracket) -> Bracket:
    """Return the bracket with times from histograms and a typical response; the shortest is 1."""
    images = bracket.images
    gray = images if images.ndim == 3 else images[..., 1]
    step = max(1, int(np.sqrt(gray[0].size / MAX_PIXELS)))
    Z = gray[:, ::step, ::step]
    g = typical_response(arrays.levels(images), bracket.linear)
    ratios = [
        light.exposure_ratio(Z[darker], Z[brighter], g)
        for darker, brighter in pairwise(mtb.by_brightness(images))
    ]
    return space_by_stops(bracket, np.maximum(np.log2(ratios), 0))


@dataclass(frozen=True, kw_only=True)
class CompletedTimes:
    """A bracket with usable times, whether they are relative, and notes and warnings about them."""

    bracket: Bracket
    are_relative: bool = False
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()


def complete_times(bracket: Bracket, times: str) -> CompletedTimes:
    """Return the bracket with usable times, and a note or a warning if they are relative.

    They are relative where all times are equal, which is also how missing times are written, and
    where the times fall while the photos get brighter. That is a warning where nobody asked for an
    estimate. `times` is the option of `assemble`.

    Raises
    ------
    InputError
        If all photos have one exposure, or if the times are to be used as stated, but all are equal
        or fall while the photos get brighter.
    """
    seconds = bracket.times
    names = bracket.names
    all_equal = np.ptp(seconds) == 0
    pair = ""
    if not all_equal:
        falling = _find_falling(bracket)
        if not len(falling):
            return CompletedTimes(bracket=bracket)
        j = int(falling[0])
        pair = f"{names[j]} ({seconds[j]:.4g} s) and {names[j + 1]} ({seconds[j + 1]:.4g} s)"
        if times == "stated":
            raise InputError(warning_text("order", pair=pair))
    relative = estimate_relative_times(bracket)
    is_one_exposure = len(seconds) < 2 or np.log2(relative.times[-1]) < MIN_SPAN_STOPS
    if is_one_exposure or (all_equal and times == "stated"):
        stated = ", ".join(
            f"{name} {time:.6g} s" for name, time in zip(names, seconds, strict=True)
        )
        raise InputError(f"expected photos with at least two different exposures, got {stated}")
    sentence = describe_relative_times(relative.times)
    if times == "estimate":
        return CompletedTimes(bracket=relative, are_relative=True, notes=(sentence,))
    if all_equal:
        warning = warning_text("no_times", relative=sentence)
    else:
        warning = warning_text("contradictory_times", pair=pair, relative=sentence)
    return CompletedTimes(bracket=relative, are_relative=True, warnings=(warning,))


def _find_falling(bracket: Bracket) -> arrays.Indices:
    """Return the photos that are brighter than the next one, which has a longer time."""
    darker_fractions = []
    # a few photos at a time, because the ranks of a thousand need more memory than small photos
    for start in range(0, len(bracket.times) - 1, MAX_RANKED_PHOTOS - 1):
        photos = slice(start, start + MAX_RANKED_PHOTOS)
        valid = None if bracket.valid is None else bracket.valid[photos]
        Z = plausibility.ranks(bracket.images[photos], valid)
        no_response = np.zeros((256, Z.shape[-1]))
        errors = plausibility.neighbour_errors(Z, bracket.times[photos], no_response)
        darker_fractions.append(errors[1])
    return np.flatnonzero(np.concatenate(darker_fractions) > 0.5)


def describe_relative_times(times: arrays.F64) -> str:
    """Return a sentence on relative times: how they were found, and how far to trust them."""
    steps = np.diff(np.log2(times))
    if len(steps) > MAX_LISTED_STEPS:
        text = f"{steps.min():.1f} to {steps.max():.1f}"
    else:
        text = ", ".join(f"{step:.1f}" for step in steps)
    return warning_text("relative", steps=text)


@dataclass(frozen=True, kw_only=True)
class CorrectedTimes:
    """An Estimate of exposure times, and the spread in stops that its times leave."""

    estimate: Estimate
    spread: float


def refine_times(
    state: Assembly,
    response: Method,
    stated_spread: float,
    *,
    is_requested: bool = False,
    has_stated_times: bool = True,
    is_aligned: bool = True,
) -> Assembly:
    """Return the Assembly with times from the pixels, if held-out pixels confirm them.

    Corrections that are larger than the rounding of stated times are a note. Smaller ones are a
    detail, unless the user requested an estimate, and so are corrections of estimates. Where the
    stated times make a worthless map, and corrections do not help, relative times replace them,
    with a warning. Close to this limit the times stay, also with a warning. `stated_spread`
    is the spread that the stated times leave in held-out pixels.
    Photos that are not aligned do not correct any times.
    """
    corrected = correct_times(state.bracket, response, stated_spread)
    # A warning about relative times has been given, and there are no stated ones to differ from.
    warnings = exposure_times.find_warnings(corrected.estimate) if has_stated_times else ()
    relative: CorrectedTimes | None = None
    if corrected.spread > MIN_WORTHLESS_STOPS / MARGIN:
        rising = select_photos(state, np.array(mtb.by_brightness(state.bracket.images)))
        relative_times = estimate_relative_times(state.bracket).times
        relative = correct_times(replace(rising.bracket, times=relative_times), response)
        max_spread = MIN_WORTHLESS_STOPS / 2
        if corrected.spread > MIN_WORTHLESS_STOPS and relative.spread < max_spread:
            # relative times do not tell how bright the scene was
            unscaled = replace(
                rising.bracket,
                luminance_of_unit=None,
                max_luminance_of_unit=None,
                has_relative_times=True,
            )
            state = replace(rising, bracket=unscaled)
            corrected = relative
            has_stated_times = False
            warnings = (_describe_replaced_times(stated_spread, relative_times),)
        elif (
            has_stated_times
            and np.isfinite(corrected.spread)
            and relative.spread < MARGIN * max_spread
        ):
            text = warning_text("maybe_replaced", stops=corrected.spread, relative=relative.spread)
            warnings = (*warnings, text)
    if not is_aligned and corrected is not relative:
        return state
    estimate = corrected.estimate
    state = replace(
        state,
        bracket=replace(state.bracket, times=estimate.times),
        warnings=(*state.warnings, *warnings),
    )
    text = exposure_times.note(estimate, state.bracket.names)
    is_news = has_stated_times and exposure_times.exceeds_rounding(estimate)
    state = state.with_note(text) if is_requested or is_news else state.with_detail(text)
    return select_photos(state, np.argsort(estimate.times, kind="stable"))


def _describe_replaced_times(spread: float, times: arrays.F64) -> str:
    """Return the warning that relative times replace the stated ones."""
    relative = describe_relative_times(times)
    if np.isinf(spread):
        return warning_text("replaced_immeasurable", relative=relative)
    return warning_text("replaced", stops=spread, relative=relative)


def correct_times(
    bracket: Bracket, response: Method, stated_spread: float | None = None
) -> CorrectedTimes:
    """Return the times of an aligned bracket, refined by its pixels.

    `stated_spread` is the spread of its own times, where it is known already.
    """

    def measure_spread(times: arrays.F64) -> float:
        return recovery.choose_response(response, replace(bracket, times=times)).spread

    images = bracket.images
    times = bracket.times
    if len(times) > MAX_REFINED_PHOTOS:
        estimate = Estimate(
            times=times,
            stops=np.zeros(len(times)),
            accepted=False,
            reason=f"hdrlab refines the times of at most {MAX_REFINED_PHOTOS} photos",
        )
        spread = measure_spread(times) if stated_spread is None else stated_spread
        return CorrectedTimes(estimate=estimate, spread=spread)
    is_linear = response == "linear" or (response == "auto" and bracket.linear)
    g = recovery.find_method("linear")(images, times) if is_linear else None
    estimate = exposure_times.estimate_times(
        images, times, measure_spread, g=g, valid=bracket.valid
    )
    if estimate.accepted:
        return CorrectedTimes(estimate=estimate, spread=estimate.spread_after)
    if stated_spread is None:
        stated_spread = measure_spread(times)
    return CorrectedTimes(estimate=estimate, spread=stated_spread)
