"""From a bracket of photos to its radiance map, stage by stage.

`assemble` returns the finished map. `assemble_steps` yields the state after each stage. Each of the
stages "align" and "response" takes the name of a method, or your own function with the same
signature.
"""

import warnings
from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from hdrlab.core import steps
from hdrlab.core.bracket import Bracket
from hdrlab.core.threads import run_in_background
from hdrlab.diagnostics import causes, consistency, motion, tones
from hdrlab.diagnostics.causes import MAX_EXPLAINED_SPREAD
from hdrlab.diagnostics.doubts import warning_text
from hdrlab.errors import InputError
from hdrlab.fast.merge import Expendable
from hdrlab.pipeline import checks, corrections, dark_pixels, recovery, registration, timing
from hdrlab.pipeline.assembly import Assembly, Method
from hdrlab.pipeline.merging import MergeRecord, merge_photos
from hdrlab.pipeline.options import FLARE, GHOSTS, MERGES, TIMES, WEIGHTS, Options
from hdrlab.radiance import scales

__all__ = [
    "CONTRADICTION",
    "FLARE",
    "GHOSTS",
    "MERGES",
    "STAGES",
    "TIMES",
    "WEIGHTS",
    "assemble",
    "assemble_steps",
    "calibrate",
]

STAGES = ("align", "times", "response", "merge", "compare")
CONTRADICTION = MAX_EXPLAINED_SPREAD


def assemble(
    bracket: Bracket,
    *,
    align: Method = "auto",
    response: Method = "auto",
    weight: str = "gaussian",
    merge: str = "shot",
    times: str = "correct",
    ghosts: str = "auto",
    flare: str = "none",
    in_place: bool = False,
    release: bool = False,
    method: str | None = None,
) -> Assembly:
    """Merge a bracket of photos into a radiance map, and check whether the map can be trusted.

    Parameters
    ----------
    bracket : Bracket
        At least two photos with different exposures.
    align : str or function
        A method of `align`, "auto", "none", or your own `align(images)`, which returns offsets
        (P, 2) in whole pixels or homographies (P, 3, 3). "mtb" shifts by whole pixels and does not
        change pixel values. "cerman" also rotates, and "homography" also corrects scale and tilt;
        both resample the photos. "auto" is "mtb", and it rotates or tilts the photos that no shift
        can align; see `pipeline.alignment`.
    response : str or function
        A method of `response`, "auto" (linear for a linear bracket, else see `pipeline.recovery`),
        or your own `recover(images, times, *, valid) -> g`.
    weight : {"gaussian", "hat", "flat", "snr"}
        Weight of each pixel value in the merge. With "gaussian", which nearly ignores very dark and
        very bright values, the photos of real brackets contradict each other least.
    merge : {"shot", "log", "likelihood", "mean"}
        How the photos are merged, see `radiance.merge`. "shot" and "likelihood" weight a photo by
        its exposure time, too: a long exposure measures the dark parts better than many short ones,
        in which the noise of the camera or the black floor of a scanner hides them. "log" is the
        mean of Debevec and Malik, whose weight depends on the pixel value alone.
    times : {"correct", "stated", "estimate"}
        "correct" refines rough exposure times by the pixels, if held-out pixels confirm it. It
        replaces times that are all equal, or that contradict the pixels everywhere, by relative
        times, with a warning, and so it does with times that fall while the photos get brighter,
        see `pipeline.timing`. "stated" keeps the times. "estimate" replaces the same times as
        "correct", without a warning.
    ghosts : {"auto", "none", "regions", "reference"}
        How to show things that moved. "none" leaves them half transparent. "regions" takes each
        moving region from the photo that exposes it best, "reference" takes all of them from the
        middle photo, see `radiance.deghosting.ghosts`. "auto" is "regions" if something moved, see
        `diagnostics.motion`, even if the photos could not be aligned. If most of the image moved,
        there is a warning.
    flare : {"none", "glare"}
        "glare" removes veiling glare, the light that the lens scattered, see `radiance.flare`.
    in_place : bool
        Whether the alignment may overwrite the images of `bracket`, which saves a copy of them.
    release : bool
        Whether the merge may free the memory of the images while it reads them, if no later stage
        needs them. Then the result's bracket holds no photos.
    method : str, optional
        Deprecated name of `merge`.

    Returns
    -------
    Assembly
        Check its `doubts` (warnings) before you use its radiance map `E`.

    Raises
    ------
    InputError
        If the bracket has fewer than two different exposures, if no pixel is well exposed in two
        photos, if times that are to be kept are in the wrong order, or if an option has an unknown value.

    Examples
    --------
    >>> from hdrlab.capture import camera
    >>> from hdrlab import scenes
    >>> photographs = camera.shoot(scenes.room((96, 144)), [0.01, 0.04, 0.16, 0.64], rng=1)
    >>> assembly = assemble(photographs)
    >>> assembly.E.shape, assembly.doubts
    ((96, 144, 3), ())
    """
    if method is not None:
        merge = _merge_from_method(method)
    states = assemble_steps(
        bracket,
        align=align,
        response=response,
        weight=weight,
        merge=merge,
        times=times,
        ghosts=ghosts,
        flare=flare,
        in_place=in_place,
        release=release,
    )
    return steps.last(states)


def assemble_steps(
    bracket: Bracket,
    *,
    align: Method = "auto",
    response: Method = "auto",
    weight: str = "gaussian",
    merge: str = "shot",
    times: str = "correct",
    ghosts: str = "auto",
    flare: str = "none",
    in_place: bool = False,
    release: bool = False,
    method: str | None = None,
) -> Iterator[Assembly]:
    """Yield the Assembly after each stage; the parameters are those of `assemble`."""
    if method is not None:
        merge = _merge_from_method(method)
    options = Options(
        align=align,
        response=response,
        weight=weight,
        merge=merge,
        times=times,
        ghosts=ghosts,
        flare=flare,
        in_place=in_place,
        release=release,
    )
    return _run_stages(bracket, options)


def _merge_from_method(method: str) -> str:
    warnings.warn(
        "the keyword `method` is deprecated; use `merge`", DeprecationWarning, stacklevel=3
    )
    return method


def _run_stages(bracket: Bracket, options: Options) -> Iterator[Assembly]:
    completed = timing.complete_times(bracket, options.times)
    bracket = completed.bracket
    has_relative_times = completed.are_relative
    state = registration.align_bracket(
        bracket,
        options.align,
        options.response,
        in_place=options.in_place,
        removes_ghosts=options.ghosts != "none",
    )
    state = replace(state, notes=(*completed.notes, *state.notes))
    yield state

    # Misaligned photos contradict each other, so contradictions are no news from here on.
    is_misaligned = state.is_misaligned
    state = replace(state, doubts=(*bracket.damaged, *completed.doubts, *state.doubts))
    checked_bracket = state.bracket
    contradictions_task = checks.start_finding_contradictions(checked_bracket)
    choice = recovery.choose_response(options.response, state.bracket)
    has_true_times = choice.spread <= timing.MAX_CONSISTENT_STOPS
    if options.times == "estimate" or (options.times == "correct" and not has_true_times):
        is_requested = options.times == "estimate" and not has_relative_times
        refined = timing.refine_times(
            state,
            options.response,
            choice.spread,
            is_requested=is_requested,
            has_stated_times=not has_relative_times,
            is_aligned=not is_misaligned or options.times == "estimate",
        )
        is_changed = not np.array_equal(refined.bracket.times, state.bracket.times)
        has_warning = refined.doubts != state.doubts
        # Notes on times that stay are news only to those who asked for an estimate.
        if is_changed or is_requested or has_warning:
            state = refined
    if options.times != "stated":
        state = replace(state, stage="times")
        yield state

    if not has_true_times:
        state = corrections.drop_outlying_frames(
            state,
            has_relative_times=has_relative_times,
            keeps_times=options.times == "stated",
        )
        choice = recovery.choose_response(options.response, state.bracket)
    if state.bracket is not checked_bracket:
        contradictions_task = checks.start_finding_contradictions(state.bracket)
    response = recovery.find_response(options.response, choice, state.bracket)
    state = replace(
        state,
        stage="response",
        g=response.g,
        details=(*state.details, *choice.notes),
        doubts=(*state.doubts, *response.doubts),
        fallback=response.fallback,
    )
    yield state

    images = state.bracket.images
    times = state.bracket.times
    valid = state.bracket.valid
    pixel_weights = WEIGHTS[options.weight](response.g)
    noise = dark_pixels.measure_noise(images[np.argmax(times)])
    merge = partial(merge_photos, method=options.merge, noise=noise)
    # A sample is merged and checked first, because the merge of all pixels may free the photos.
    grid = np.s_[:, *consistency.choose_grid(images.shape[1:3])]
    sample = images[grid]
    if sample.shape != images.shape:
        sample = sample.copy()  # contiguous, because it is read several times
    sample_valid = None if valid is None else valid[grid]
    sample_map = merge(sample, times, response.g, pixel_weights, valid=sample_valid, repair=False).E
    motion_task = run_in_background(
        partial(motion.measure_motion, images, times, response.g, pixel_weights, valid=valid),
        pixels=images[0].size,
    )
    medians_task = run_in_background(
        partial(consistency.measure_level_exposures, sample, times, sample_map, valid=sample_valid),
        pixels=images[0].size,
    )
    blocks_task = run_in_background(
        partial(
            tones.measure_block_errors,
            sample,
            times,
            response.g,
            sample_map,
            valid=sample_valid,
        ),
        pixels=images[0].size,
    )
    measured_motion = motion_task.result()
    medians = medians_task.result()
    block_errors = blocks_task.result()
    contradictions = contradictions_task.result()

    # Photos that "mtb" could not align may be rotated, and "auto" would align them. With any other
    # method, something moved that no alignment undoes.
    is_explained_by_rotation = is_misaligned and options.align == "mtb"
    is_moving = causes.is_moving(*measured_motion)
    may_have_ghosts = is_moving and not is_explained_by_rotation
    removes_ghosts = options.ghosts in ("regions", "reference") or (
        options.ghosts == "auto" and may_have_ghosts
    )
    is_usable = not state.fallback and not checks.is_worthless(medians)
    if options.release and is_usable and not removes_ghosts:
        state = replace(state, bracket=replace(state.bracket, images=images[:0].copy()))
        images = images.view(Expendable)
    # The certainty is measured first, because the merge may free the photos.
    certainty = dark_pixels.measure_color_certainty(images, times, valid=valid, noise=noise)
    merged = merge(images, times, response.g, pixel_weights, valid=valid)
    state = replace(state, stage="merge", E=merged.E, quality=merged.quality)
    neutral = np.ones(3, np.float32)
    if certainty is not None:
        neutral = dark_pixels.measure_neutral(state.E, certainty)
        E = dark_pixels.fade_to_neutral(merged.E, certainty, neutral=neutral, in_place=True)
        state = replace(state, E=E)
        black_fraction = dark_pixels.measure_black_fraction(certainty)
        if black_fraction >= dark_pixels.MIN_BLACK_FRACTION:
            state = state.with_doubt(warning_text("black", percent=100 * black_fraction))
    if not options.release:
        record = MergeRecord(
            method=options.merge,
            pixel_weights=pixel_weights,
            noise=noise,
            certainty=certainty,
            neutral=neutral,
        )
        state = replace(state, record=record)
    yield state

    if removes_ghosts:
        state = corrections.remove_ghosts(
            state,
            options.ghosts,
            pixel_weights,
            merge,
            certainty=certainty,
            neutral=neutral,
            is_misaligned=is_misaligned,
        )
        if state.moving is not None:
            yield state
    if options.flare != "none":
        state = corrections.remove_glare(state)
        yield state

    moving = None if state.moving is None else state.moving[grid[1:]]
    part_errors = tones.measure_part_errors(block_errors, moving=moving)
    if state.moving is not None or is_misaligned:
        measured_motion = motion.Motion(fraction=0.0, band_stops=0.0)
    elif removes_ghosts:
        # The photos contradict each other, but nothing moved.
        measured_motion = measured_motion._replace(fraction=0.0)
    checked = checks.check_map(
        state,
        medians,
        contradictions,
        measured_motion.fraction,
        measured_motion.band_stops,
        part_errors,
        options=options,
    )
    if is_misaligned:
        checked = replace(checked, doubts=state.doubts)
    yield checked


def calibrate(state: Assembly, x: int, y: int, reading: float) -> Assembly:
    """Return the Assembly with E in cd/m^2, from a light meter's reading at pixel (x, y).

    See `radiance.scales.fit_unit`.
    """
    if state.quality[y : y + 1, x : x + 1].any():
        raise InputError(f"no photo is well exposed at {x},{y}; choose another pixel")
    factor = np.float32(scales.fit_unit(state.E, x, y, reading))
    record = state.record
    if record is not None:
        record = replace(record, unit_factor=record.unit_factor * float(factor))
    calibrated = replace(
        state,
        bracket=replace(state.bracket, luminance_of_unit=1.0),
        E=state.E * factor,
        s=None if state.s is None else state.s * factor,
        record=record,
    )
    return calibrated.with_note(
        f"1 in the map is 1 cd/m^2: the light meter read {reading:g} cd/m^2 at {x},{y}"
    )
