"""From a bracket of photos to its radiance map, stage by stage.

`assemble` returns the finished map. `assemble_steps` yields the state after each stage. Each of the
stages "align" and "response" takes the name of a method, or your own function with the same
signature.
"""

import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from hdrlab.core import steps
from hdrlab.core.arrays import F32, F64
from hdrlab.core.bracket import Bracket
from hdrlab.core.threads import Task, run_in_background
from hdrlab.diagnostics import causes, consistency, motion, tones
from hdrlab.diagnostics.contradictions import Contradictions
from hdrlab.diagnostics.warning_texts import warning_text
from hdrlab.errors import InputError
from hdrlab.fast.merge import Expendable
from hdrlab.pipeline import checks, corrections, dark_pixels, recovery, registration, timing
from hdrlab.pipeline.assembly import Assembly, Method
from hdrlab.pipeline.merging import MergeRecord, merge_photos
from hdrlab.pipeline.options import FLARE, GHOSTS, MERGES, TIMES, WEIGHTS, Options
from hdrlab.radiance import scales
from hdrlab.radiance.merge import Merged

__all__ = [
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
        Check its `warnings` (warnings) before you use its radiance map `E`.

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
    >>> assembly.E.shape, assembly.warnings
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
    """Run the stages one after the other, and yield the state after each."""
    completed = timing.complete_times(bracket, options.times)
    state = _align(completed, options)
    yield state

    # Misaligned photos contradict each other, so contradictions are no news from here on.
    is_misaligned = state.is_misaligned
    state = replace(
        state, warnings=(*completed.bracket.damaged, *completed.warnings, *state.warnings)
    )
    checked_bracket = state.bracket
    contradictions_task = checks.start_finding_contradictions(checked_bracket)
    choice = recovery.choose_response(options.response, state.bracket)
    has_true_times = choice.spread <= timing.MAX_CONSISTENT_STOPS
    if options.times == "estimate" or (options.times == "correct" and not has_true_times):
        state = _refine_times(
            state,
            options,
            choice.spread,
            has_relative_times=completed.are_relative,
            is_misaligned=is_misaligned,
        )
    if options.times != "stated":
        state = replace(state, stage="times")
        yield state

    if not has_true_times:
        state = corrections.drop_outlying_frames(
            state,
            has_relative_times=completed.are_relative,
            keeps_times=options.times == "stated",
        )
        choice = recovery.choose_response(options.response, state.bracket)
    if state.bracket is not checked_bracket:
        contradictions_task = checks.start_finding_contradictions(state.bracket)
    state = _find_response(state, options, choice)
    yield state

    plan = _plan_merge(state, options)
    measurements = _measure_photos(state, plan, contradictions_task)
    removes_ghosts = _should_remove_ghosts(
        measurements.motion, options, is_misaligned=is_misaligned
    )
    is_usable = not state.fallback and not checks.is_worthless(measurements.medians)
    frees_photos = options.release and is_usable and not removes_ghosts
    merged = _merge(state, plan, frees_photos=frees_photos)
    state = merged.state
    if not options.release:
        state = replace(state, record=_make_record(merged, plan, options))
    yield state

    if removes_ghosts:
        state = corrections.remove_ghosts(
            state,
            options.ghosts,
            plan.pixel_weights,
            plan.merge,
            certainty=merged.certainty,
            neutral=merged.neutral,
            is_misaligned=is_misaligned,
        )
        if state.moving is not None:
            yield state
    if options.flare != "none":
        state = corrections.remove_glare(state)
        yield state

    checked = _check_map(
        state, measurements, options, is_misaligned=is_misaligned, removes_ghosts=removes_ghosts
    )
    if is_misaligned:
        checked = replace(checked, warnings=state.warnings)
    yield checked


@dataclass(frozen=True, kw_only=True)
class _MergePlan:
    """How the photos are merged.

    Attributes
    ----------
    merge : function
        `merge_photos` with the method and the noise of this bracket.
    pixel_weights : (n,)
        Weights of the pixel values.
    noise : float
        Noise of dark pixels in the longest photo, in pixel values.
    """

    merge: Callable[..., Merged]
    pixel_weights: F64
    noise: float


@dataclass(frozen=True, kw_only=True)
class _Measurements:
    """What was measured in the photos before the merge, because the merge may free them.

    Attributes
    ----------
    grid : (slice, slice)
        Rows and columns of the pixels that were compared, except for `motion`.
    medians : (P, C, 256)
        See `Assembly`.
    block_errors : BlockErrors
        Differences between the map of the grid and the photos.
    motion : Motion
        How much of the image moved.
    contradictions : Contradictions
        Photos that contradict each other.
    """

    grid: tuple[slice, slice]
    medians: F64
    block_errors: tones.BlockErrors
    motion: motion.Motion
    contradictions: Contradictions


@dataclass(frozen=True, kw_only=True)
class _MergedState:
    """The state after the merge, and the colors of its dark pixels, which `remove_ghosts` needs too.

    Attributes
    ----------
    state : Assembly
        The state with its map.
    certainty : (h, w) float32 or None
        How certain the color of each pixel is, see `dark_pixels.measure_color_certainty`.
    neutral : (3,) float32
        The color to which uncertain pixels fade.
    """

    state: Assembly
    certainty: F32 | None
    neutral: F32


def _align(completed: timing.CompletedTimes, options: Options) -> Assembly:
    """Align the photos, and add the notes about their times."""
    state = registration.align_bracket(
        completed.bracket,
        options.align,
        options.response,
        in_place=options.in_place,
        removes_ghosts=options.ghosts != "none",
    )
    return replace(state, notes=(*completed.notes, *state.notes))


def _refine_times(
    state: Assembly,
    options: Options,
    spread: float,
    *,
    has_relative_times: bool,
    is_misaligned: bool,
) -> Assembly:
    """Return the state with times that are refined by the pixels, or unchanged if these confirm them."""
    is_requested = options.times == "estimate" and not has_relative_times
    refined = timing.refine_times(
        state,
        options.response,
        spread,
        is_requested=is_requested,
        has_stated_times=not has_relative_times,
        is_aligned=not is_misaligned or options.times == "estimate",
    )
    is_changed = not np.array_equal(refined.bracket.times, state.bracket.times)
    has_warning = refined.warnings != state.warnings
    # Notes on times that stay are news only to those who asked for an estimate.
    if is_changed or is_requested or has_warning:
        return refined
    return state


def _find_response(state: Assembly, options: Options, choice: recovery.ResponseChoice) -> Assembly:
    """Return the state with the camera's response."""
    response = recovery.find_response(options.response, choice, state.bracket)
    return replace(
        state,
        stage="response",
        g=response.g,
        details=(*state.details, *choice.notes),
        warnings=(*state.warnings, *response.warnings),
        fallback=response.fallback,
    )


def _plan_merge(state: Assembly, options: Options) -> _MergePlan:
    """Measure the noise of the longest photo, and choose the weights of the merge."""
    bracket = state.bracket
    noise = dark_pixels.measure_noise(bracket.images[np.argmax(bracket.times)])
    return _MergePlan(
        merge=partial(merge_photos, method=options.merge, noise=noise),
        pixel_weights=WEIGHTS[options.weight](state.g),
        noise=noise,
    )


def _measure_photos(
    state: Assembly, plan: _MergePlan, contradictions_task: Task[Contradictions]
) -> _Measurements:
    """Merge a sample of the pixels, and compare the photos with it and with each other."""
    images = state.bracket.images
    times = state.bracket.times
    valid = state.bracket.valid
    g = state.g
    grid = consistency.choose_grid(images.shape[1:3])
    sample = images[:, *grid]
    if sample.shape != images.shape:
        sample = sample.copy()  # contiguous, because it is read several times
    sample_valid = None if valid is None else valid[:, *grid]
    sample_map = plan.merge(
        sample, times, g, plan.pixel_weights, valid=sample_valid, repair=False
    ).E
    motion_task = run_in_background(
        partial(motion.measure_motion, images, times, g, plan.pixel_weights, valid=valid),
        pixels=images[0].size,
    )
    medians_task = run_in_background(
        partial(consistency.measure_level_exposures, sample, times, sample_map, valid=sample_valid),
        pixels=images[0].size,
    )
    blocks_task = run_in_background(
        partial(tones.measure_block_errors, sample, times, g, sample_map, valid=sample_valid),
        pixels=images[0].size,
    )
    return _Measurements(
        grid=grid,
        motion=motion_task.result(),
        medians=medians_task.result(),
        block_errors=blocks_task.result(),
        contradictions=contradictions_task.result(),
    )


def _should_remove_ghosts(
    measured: motion.Motion, options: Options, *, is_misaligned: bool
) -> bool:
    """Return whether to remove ghosts, because of the option `ghosts` or because something moved."""
    if options.ghosts != "auto":
        return options.ghosts != "none"
    # Photos that "mtb" could not align may be rotated, and "auto" would align them. With any other
    # method, something moved that no alignment undoes.
    is_explained_by_rotation = is_misaligned and options.align == "mtb"
    is_moving = causes.is_moving(measured.fraction, measured.band_stops)
    return is_moving and not is_explained_by_rotation


def _merge(state: Assembly, plan: _MergePlan, *, frees_photos: bool) -> _MergedState:
    """Merge the photos, and fade the colors of pixels that are black in every photo."""
    images = state.bracket.images
    times = state.bracket.times
    valid = state.bracket.valid
    if frees_photos:
        state = replace(state, bracket=replace(state.bracket, images=images[:0].copy()))
        images = images.view(Expendable)
    # The certainty is measured first, because the merge may free the photos.
    certainty = dark_pixels.measure_color_certainty(images, times, valid=valid, noise=plan.noise)
    merged = plan.merge(images, times, state.g, plan.pixel_weights, valid=valid)
    state = replace(state, stage="merge", E=merged.E, quality=merged.quality)
    if certainty is None:
        return _MergedState(state=state, certainty=None, neutral=np.ones(3, np.float32))
    neutral = dark_pixels.measure_neutral(state.E, certainty)
    E = dark_pixels.fade_to_neutral(merged.E, certainty, neutral=neutral, in_place=True)
    state = replace(state, E=E)
    black_fraction = dark_pixels.measure_black_fraction(certainty)
    if black_fraction >= dark_pixels.MIN_BLACK_FRACTION:
        state = state.with_warning(warning_text("black", percent=100 * black_fraction))
    return _MergedState(state=state, certainty=certainty, neutral=neutral)


def _make_record(merged: _MergedState, plan: _MergePlan, options: Options) -> MergeRecord:
    """Return the record of the merge that `Assembly.why` needs."""
    return MergeRecord(
        method=options.merge,
        pixel_weights=plan.pixel_weights,
        noise=plan.noise,
        certainty=merged.certainty,
        neutral=merged.neutral,
    )


def _check_map(
    state: Assembly,
    measurements: _Measurements,
    options: Options,
    *,
    is_misaligned: bool,
    removes_ghosts: bool,
) -> Assembly:
    """Return the finished state with warnings about the map."""
    moving = None if state.moving is None else state.moving[measurements.grid]
    part_errors = tones.measure_part_errors(measurements.block_errors, moving=moving)
    measured_motion = measurements.motion
    unresolved_fraction = 0.0
    if state.moving is not None or is_misaligned:
        measured_motion = motion.Motion(fraction=0.0, band_stops=0.0)
    elif removes_ghosts:
        # The photos contradict each other, but no region of them has ghosts.
        unresolved_fraction = measured_motion.fraction
        measured_motion = measured_motion._replace(fraction=0.0)
    return checks.check_map(
        state,
        measurements.medians,
        measurements.contradictions,
        measured_motion.fraction,
        measured_motion.band_stops,
        part_errors,
        options=options,
        unresolved_fraction=unresolved_fraction,
    )


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
