"""Refine rough exposure times by the pixels.

B       ln stated times   (P,)
x       corrections       (P,), ln(time / stated time): see `response_steps`, for the gauge too
spread  of the photos in the map that times make, in stops: a function of the caller

An estimate fits the pixels that it was made from better than any stated times, and may still be worse:
motion, flare, and a response that changes from photo to photo look like wrong times. So it is
validated twice: on held-out tiles of the image, and in the map. If it does not pass, the stated
times stay.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, as_response, as_stack
from hdrlab.diagnostics import flat_patches, response_steps
from hdrlab.diagnostics.warning_texts import warning_text

# stops; a time that is off by more is worth a warning
MAX_ROUGH_STOPS = 0.5
# stops, the largest correction of three times; a larger one is not due to rounding in the camera
MAX_ROUNDING_STOPS = 0.08
# stops of bias; times that agree so well with the pixels are not changed
MAX_EXACT_BIAS = 0.005
# One time is wrong alone if all other corrections are smaller than its correction divided by this.
MIN_SINGLE_OUT_RATIO = 8
# corrections that a note names
MAX_NAMED_CORRECTIONS = 2


@dataclass(frozen=True, eq=False)
class Estimate:
    """Exposure times from the pixels, and whether to use them.

    Attributes
    ----------
    times : (P,) float
        Seconds, to be used: the estimated times if they were accepted, else the stated ones.
    stops : (P,) float
        log2(estimated / stated), whether accepted or not.
    accepted : bool
        Whether the estimate is better, by held-out pixels and by the spread.
    reason : str
        Why, or why not, as a sentence.
    bias_before, bias_after : float
        Stops by which pairs of photos disagree in held-out tiles.
    spread_before, spread_after : float
        Stops, from the caller's `spread`; NaN if it was not called.
    """

    times: F64
    stops: F64
    accepted: bool
    reason: str
    bias_before: float = float("nan")
    bias_after: float = float("nan")
    spread_before: float = float("nan")
    spread_after: float = float("nan")


def estimate_times(
    images: ArrayLike,
    times: ArrayLike,
    spread: Callable[[F64], float] | None = None,
    *,
    g: ArrayLike | None = None,
    sd: float = 1 / 6,
    gain: float = 0.1,
    valid: ArrayLike | None = None,
) -> Estimate:
    """Estimate the exposure times of a bracket from its pixels, and keep the stated ones if in doubt.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Aligned photos, from short to long.
    times : (P,) float
        Stated times in seconds. Their geometric mean does not change, and if g is not known,
        neither does their span: the corrections are orthogonal to 1, and to ln times. But if only
        one of four or more times is wrong, all others stay.
    spread : function, optional
        times -> stops, how far the photos contradict each other in the map that these times make;
        the estimate must not raise it. It is called only if the held-out pixels agree better.
    g : (n,) or (n, 3) float, optional
        The response, ln exposure, if it is known (a linear camera); otherwise it is fitted, too.
    sd : float
        Prior of a stated time's error, in stops. The estimate is shrunk to it.
    gain : float
        Fraction by which the bias in held-out tiles must fall.
    valid : (P, H, W) bool, optional
        False where a photo has no image.

    Returns
    -------
    Estimate

    Raises
    ------
    InputError
        If photos, times, response or mask do not fit together, or the times fall.

    Examples
    --------
    >>> from hdrlab.capture import camera
    >>> from hdrlab import scenes
    >>> room = scenes.room((280, 420))
    >>> taken = camera.shoot(room, camera.times_around(room, 5, stops=1.5))
    >>> estimate_times(taken.images, taken.times * [1, 1, 1.1, 1, 1]).accepted
    True
    """
    stack = as_stack(images)
    times = response_steps.as_ascending_times(times, len(stack))
    B = np.log(times)
    Q = response_steps.free_directions(B, known=g is not None)
    if g is not None:
        g = as_response(g, 256, stack[0, 0, 0].size).T
    stated = Estimate(times=times, stops=np.zeros(len(times)), accepted=False, reason="")
    if Q.shape[1] == 0:
        return replace(
            stated, reason="two photos do not determine both their times and their response"
        )
    patches = flat_patches.find_flat_patches(stack, valid=valid)
    H = flat_patches.count_pairs(patches.Z, patches.best)
    if not response_steps.find_informative(H).any():
        return replace(stated, reason="too few patches are uniform in two neighboring photos")
    no_directions = np.zeros((len(times), 0))
    bias_before = cross_validate(patches, B, no_directions, g=g, sd=sd)
    stated = replace(stated, bias_before=bias_before)
    if bias_before <= MAX_EXACT_BIAS:
        reason = f"the stated times agree with the pixels to {bias_before:.3f} stops"
        return replace(stated, reason=reason)
    x = response_steps.fit_steps(H, B, Q, g=g, sd=sd).x
    if g is None:
        x = single_out(x, B)
    bias_after = cross_validate(patches, B, Q, g=g, sd=sd)
    stated = replace(stated, stops=x / np.log(2), bias_after=bias_after)
    change = f"from {bias_before:.3f} to {bias_after:.3f} stops"
    if not bias_after <= (1 - gain) * bias_before:
        return replace(stated, reason=f"held-out pixels would agree no better ({change})")
    return _check_spread(stated, np.exp(B + x), change, spread)


def single_out(x: F64, B: F64) -> F64:
    """Return corrections that change a single time, if such explain the same pixels; else x.

    The pixels do not determine a straight line in B. If one time is wrong, x spreads its error over
    all times.

    Examples
    --------
    >>> B = np.arange(5.0)
    >>> x = np.array([0, 0, 0, 0, 1]) - 0.2 * B  # the last time is wrong
    >>> single_out(x, B).round(3).tolist()
    [0.0, 0.0, 0.0, 0.0, 1.0]
    """
    if len(B) <= 3:
        return x
    without_trend = response_steps.remove_trend(x, B)
    sizes = np.sort(np.abs(without_trend))
    largest = sizes[-1]
    is_alone = sizes[-2] < largest / MIN_SINGLE_OUT_RATIO
    is_large = largest > MAX_ROUNDING_STOPS * np.log(2)
    return without_trend if is_alone and is_large else x


def _check_spread(
    stated: Estimate, times: F64, change: str, spread: Callable[[F64], float] | None
) -> Estimate:
    """Return the Estimate with other times, unless they raise the spread."""
    if spread is not None:
        spread_before = spread(stated.times)
        spread_after = spread(times)
        stated = replace(stated, spread_before=spread_before, spread_after=spread_after)
        if not spread_after <= spread_before:
            change = f"from {spread_before:.3f} to {spread_after:.3f} stops"
            return replace(stated, reason=f"the map's spread would rise {change}")
    return replace(
        stated, times=times, accepted=True, reason=f"held-out pixels disagree less, {change}"
    )


def cross_validate(
    patches: flat_patches.FlatPatches, B: F64, Q: F64, *, g: F64 | None, sd: float
) -> float:
    """Return the mean absolute bias, in stops, of a fit to half of the flat patches in the other half.

    Each half is held out once.
    """
    is_black = flat_patches.checkerboard(patches.flat.shape[1:])
    black = flat_patches.count_pairs(patches.Z, patches.best & is_black)
    white = flat_patches.count_pairs(patches.Z, patches.best & ~is_black)
    biases = []
    for fitted, held_out in ((black, white), (white, black)):
        fit = response_steps.fit_steps(fitted, B, Q, g=g, sd=sd)
        biases.append(response_steps.measure_biases(held_out, B, fit))
    if not np.isfinite(biases).any():
        return float("nan")
    return float(np.nanmean(np.abs(biases)))


def note(found: Estimate, names: Sequence[str]) -> str:
    """Return a sentence on what was found, with the largest corrections."""
    if not found.accepted:
        return f"the stated times stay: {found.reason}"
    by_size = sorted(range(len(names)), key=lambda j: -abs(found.stops[j]))
    largest = ", ".join(
        f"{names[j]} {found.stops[j]:+.3f}" for j in by_size[:MAX_NAMED_CORRECTIONS]
    )
    count = np.count_nonzero(np.abs(found.stops) > MAX_EXACT_BIAS)
    return (
        f"times estimated from the pixels: {count} of {len(names)} corrected, most {largest} stops; "
        f"{found.reason}"
    )


def exceeds_rounding(found: Estimate) -> bool:
    """Return whether an accepted estimate is farther from the stated times than their rounding."""
    return found.accepted and float(np.abs(found.stops).max()) > MAX_ROUNDING_STOPS


def find_warnings(found: Estimate) -> tuple[str, ...]:
    """Return warnings about estimated times: one sentence, or none."""
    if not found.accepted:
        return ()
    largest = float(np.abs(found.stops).max())
    if len(found.stops) == 3:
        if largest > MAX_ROUNDING_STOPS:
            return (warning_text("one_of_three", middle=1.5 * largest, end=3 * largest),)
    elif largest > MAX_ROUGH_STOPS:
        return (warning_text("far", stops=largest),)
    return ()
