"""The response of a bracket: by a method of `response`, by your own function, or by "auto".

With "auto", held-out pixels choose whether the channels share a curve, or may depart from one.
A gray surface has the same value in all channels, and so it should have the same radiance. Three
curves that are recovered separately disagree where few photos constrain them, and then a gray wall
gets colored patches. One curve for all channels cannot do that. Digital cameras usually have one
curve; scanned film has three. With `tied_curves`, the channels depart from a shared curve as far as
their pixels say. One curve wins if it explains held-out pixels as well in all tones and channels.
Debevec's curves, which need no prior, are for cameras that no prior knows: they win if they explain
held-out pixels much better.

A map needs some response. If a method finds none, or one that no camera has, the response that a
prior makes most likely takes its place, with a warning: that of `response.space`.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from hdrlab.core import metrics, sampling, weights
from hdrlab.core.arrays import F64, ArrayLike, Indices, as_mask, as_stack
from hdrlab.core.bracket import Bracket
from hdrlab.diagnostics import consistency, plausibility
from hdrlab.diagnostics.frame_choice import choose_spread_frames
from hdrlab.diagnostics.warning_texts import warning_text
from hdrlab.errors import CalibrationError, InputError
from hdrlab.fast import debevec, merge, robertson
from hdrlab.pipeline import catalogue, tied_curves
from hdrlab.pipeline.assembly import Method
from hdrlab.response import self_calibration, space

Recover = Callable[..., F64]

# pixels of a photo, on an even grid, that are used to compare methods
MAX_PIXELS = 2**16
# photos, spread over the exposure times, from which a response is recovered
MAX_FITTED_PHOTOS = 32
# photos whose held-out pixels are compared
MAX_HELD_OUT_PHOTOS = 64
# stripes of rows in a photo; every other one is held out
STRIPE_COUNT = 20
# How much more RMS spread a method that ties the channels more may leave, relative to the best.
MAX_RELATIVE_LOSS = 0.005
# How much less RMS spread a method without a prior must leave, relative to the others.
MIN_RELATIVE_GAIN = 0.3
# consecutive pixel values that smoothness alone may connect
MAX_GAP = 20
# samples that show which pixel values two photos share
SAMPLE_COUNT = 1000


@dataclass(frozen=True, kw_only=True)
class ResponseChoice:
    """A method, the spread in stops that it leaves in held-out pixels, and notes on the choice."""

    method: Recover
    spread: float
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class FoundResponse:
    """The response g of a bracket, warnings, and why no map that it makes is usable, or ""."""

    g: F64
    warnings: tuple[str, ...] = ()
    fallback: str = ""


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """A method that "auto" may choose."""

    name: str
    method: Recover
    # Whether the curves that cameras have, see `response.space`, guide the method.
    has_prior: bool
    # Whether smoothness alone connects pixel values that no two photos share.
    needs_shared_values: bool


@dataclass(frozen=True, kw_only=True)
class HeldOutSpread:
    """The spread that a response leaves in held-out pixels, in stops; infinite without a response.

    Attributes
    ----------
    typical : float
        Mean over the channels of `consistency.measure_spread`.
    rms : float
        See `consistency.measure_rms_spread`: it shows what a median hides.
    """

    typical: float
    rms: float


def find_method(response: Method) -> Recover:
    """Return a method by its name, with the extensions of EXTENDED; a function is returned as it is."""
    if isinstance(response, str) and response in EXTENDED:
        return EXTENDED[response]
    return catalogue.method("response", response)


def find_validated_method(response: Method) -> Recover:
    """Return a method that raises a CalibrationError for a response that contradicts the photos.

    Your own function is returned as it is, and so is "linear", which does not look at the photos.
    """
    method = find_method(response)
    if callable(response) or response == "linear":
        return method
    return partial(_recover_validated, method)


def _recover_validated(
    method: Recover, images: ArrayLike, times: ArrayLike, *, valid: ArrayLike | None = None
) -> F64:
    """Return the response that a method finds, checked by `validate_response`."""
    g = method(images, times, valid=valid)
    return plausibility.validate_response(g, images, times, valid=valid)


def share_curve(method: Recover) -> Recover:
    """Return a method that recovers one curve from the pixel values of all channels together."""

    def recover(images: ArrayLike, times: ArrayLike, *, valid: ArrayLike | None = None) -> F64:
        stack = as_stack(images)
        mask = as_mask(valid, stack)
        channels = stack.shape[3:]
        gray = stack.reshape(*stack.shape[:2], -1)
        if mask is not None:
            mask = np.repeat(mask, np.prod(channels, dtype=int), axis=2)
        g = method(gray, times, valid=mask)
        return np.multiply.outer(g, np.ones(channels))

    return recover


# Methods that need more than their paper for photos of everyday cameras.
EXTENDED: dict[str, Recover] = {
    "robertson": partial(robertson.recover, steps=robertson.Smooth(100)),
    "mitsunaga": self_calibration.find_response,
}

# from tied channels to free ones
CANDIDATES = (
    Candidate(
        name="one curve by space",
        method=share_curve(space.recover),
        has_prior=True,
        needs_shared_values=False,
    ),
    Candidate(
        name="curves that are tied to each other",
        method=partial(tied_curves.recover, departure=0.5),
        has_prior=True,
        needs_shared_values=False,
    ),
    Candidate(
        name="a curve for each channel by debevec",
        method=debevec.recover,
        has_prior=False,
        needs_shared_values=True,
    ),
)


def split_stripes(bracket: Bracket) -> tuple[Bracket, Bracket]:
    """Return every other stripe of rows of a bracket, thinned to MAX_PIXELS, and the stripes between."""
    height, width = bracket.images.shape[1:3]
    step = max(1, int(np.sqrt(height * width / MAX_PIXELS)))
    rows = np.arange(0, height, step)
    is_held_out = rows * STRIPE_COUNT // height % 2 == 1

    def take_rows(chosen: Indices) -> Bracket:
        images = bracket.images[:, chosen, ::step]
        valid = None if bracket.valid is None else bracket.valid[:, chosen, ::step]
        return replace(bracket, images=images, valid=valid)

    return take_rows(rows[~is_held_out]), take_rows(rows[is_held_out])


def thin_photos(bracket: Bracket, count: int = MAX_FITTED_PHOTOS) -> Bracket:
    """Return a bracket with at most `count` of its photos, spread over the exposure times.

    More photos hardly change the response, and each of them is compared with each.
    """
    chosen = choose_spread_frames(bracket.times, count)
    if len(chosen) == len(bracket.times):
        return bracket
    return replace(
        bracket,
        images=bracket.images[chosen],
        times=bracket.times[chosen],
        names=tuple(bracket.names[j] for j in chosen),
        valid=None if bracket.valid is None else bracket.valid[chosen],
    )


def find_widest_gap(Z: ArrayLike) -> int:
    """Return the most consecutive pixel values that no sample of Z (N, P) shows in two photos.

    Only values between the darkest and the brightest one in Z count.

    Examples
    --------
    >>> find_widest_gap([[100, 200], [101, 201], [20, 255]])  # only one photo shows 20
    99
    """
    Z = np.asarray(Z)
    is_inside = (Z >= metrics.LOW_LEVEL) & (Z <= metrics.HIGH_LEVEL)
    is_shared = is_inside & (is_inside.sum(axis=1, keepdims=True) > 1)
    shown = Z[is_inside]
    if not len(shown):
        return 256
    connected = np.unique([shown.min(), *Z[is_shared], shown.max()])
    return int(np.diff(connected).max(initial=1))


def measure_spread(method: Recover, fit: Bracket, held_out: Bracket) -> HeldOutSpread:
    """Return the spread in stops that a method's response leaves in held-out pixels.

    It is infinite if the method finds no response, and for photos of a few rows, of which no pixel
    is held out.
    """
    if not held_out.images.size:
        return HeldOutSpread(typical=np.inf, rms=np.inf)
    try:
        g = method(fit.images, fit.times, valid=fit.valid)
    except InputError:
        return HeldOutSpread(typical=np.inf, rms=np.inf)
    E = merge.merge_with_quality(
        held_out.images, held_out.times, g, weights.gaussian(len(g)), valid=held_out.valid
    ).E
    medians = consistency.measure_level_exposures(
        held_out.images, held_out.times, E, valid=held_out.valid
    )
    spreads = [
        consistency.measure_spread(medians[:, channel : channel + 1])
        for channel in range(medians.shape[1])
    ]
    typical = float(np.nan_to_num(np.mean(spreads), nan=np.inf))
    rms = float(np.nan_to_num(consistency.measure_rms_spread(medians), nan=np.inf))
    return HeldOutSpread(typical=typical, rms=rms)


def choose_response(response: Method, bracket: Bracket) -> ResponseChoice:
    """Return the method for an aligned bracket: the one that is named, or the best one for "auto".

    Debevec's method is not a candidate where smoothness alone would connect its pixel values. If no
    method can be compared, it is used all the same.
    """
    fit, held_out = split_stripes(thin_photos(bracket, MAX_HELD_OUT_PHOTOS))
    fit = thin_photos(fit)
    if response != "auto" or bracket.linear:
        method = find_validated_method("linear" if response == "auto" else response)
        spread = measure_spread(method, fit, held_out)
        return ResponseChoice(method=method, spread=spread.typical)
    has_gap = _has_wide_gap(fit)
    spreads: dict[str, HeldOutSpread] = {}
    for candidate in _list_candidates(bracket):
        if not (has_gap and candidate.needs_shared_values):
            method = partial(_recover_validated, candidate.method)
            spreads[candidate.name] = measure_spread(method, fit, held_out)
    best = _find_best(spreads)
    if best is None:
        return ResponseChoice(method=find_validated_method("debevec"), spread=np.inf)
    compared = ", ".join(f"{name} {spread.rms:.3f}" for name, spread in spreads.items())
    note = (
        f"response: {best.name}, chosen by the RMS spread in held-out pixels, in stops: {compared}"
    )
    return ResponseChoice(
        method=partial(_recover_validated, best.method),
        spread=spreads[best.name].typical,
        notes=(note,),
    )


def _list_candidates(bracket: Bracket) -> tuple[Candidate, ...]:
    """Return the candidates for a bracket; gray photos have no channels to tie."""
    if bracket.images.ndim == 4:
        return CANDIDATES
    return (CANDIDATES[0], CANDIDATES[-1])


def _find_best(spreads: dict[str, HeldOutSpread]) -> Candidate | None:
    """Return the candidate to use, or None if none has a finite spread."""
    compared = [
        candidate
        for candidate in CANDIDATES
        if candidate.name in spreads and np.isfinite(spreads[candidate.name].typical)
    ]
    if not compared:
        return None
    with_prior = [candidate for candidate in compared if candidate.has_prior]
    without_prior = [candidate for candidate in compared if not candidate.has_prior]
    if not with_prior:
        return without_prior[0]
    max_rms = (1 + MAX_RELATIVE_LOSS) * min(spreads[candidate.name].rms for candidate in with_prior)
    best = next(candidate for candidate in with_prior if spreads[candidate.name].rms <= max_rms)
    for candidate in without_prior:
        if spreads[candidate.name].rms < (1 - MIN_RELATIVE_GAIN) * spreads[best.name].rms:
            best = candidate
    return best


def _has_wide_gap(bracket: Bracket) -> bool:
    """Return whether in any channel more than MAX_GAP pixel values in a row are not shared."""
    Z = sampling.by_rank(bracket.images, SAMPLE_COUNT, valid=bracket.valid)
    Z = Z.reshape(SAMPLE_COUNT, len(bracket.times), -1)
    return any(find_widest_gap(Z[..., channel]) > MAX_GAP for channel in range(Z.shape[-1]))


def find_response(response: Method, choice: ResponseChoice, bracket: Bracket) -> FoundResponse:
    """Return the response of an aligned bracket, with warnings.

    Errors of your own function are not caught.

    Raises
    ------
    CalibrationError
        If no pixel is well exposed in two photos.
    """
    if not callable(response):
        bracket = thin_photos(bracket)
    images = bracket.images
    times = bracket.times
    valid = bracket.valid
    try:
        return FoundResponse(g=choice.method(images, times, valid=valid))
    except InputError as error:
        if callable(response):
            raise
        warning = warning_text("no_response", error=error)
    try:
        g = space.recover(images, times, valid=valid)
    except InputError as error:
        raise CalibrationError(warning_text("in_common", error=error)) from None
    try:
        plausibility.validate_response(g, images, times, valid=valid)
    except CalibrationError:
        return FoundResponse(g=g, warnings=(warning,), fallback=warning)
    return FoundResponse(g=g, warnings=(warning,))
