"""Exposure times from the pixels, where the stated ones are rough.

B       ln stated times   (P,)
x       corrections       (P,), ln(time / stated time): see `response_steps`, for the gauge too
spread  of the frames in the map that times make, stops: a function of the caller

An estimate fits the pixels that it was made from better than any stated times, and may still be worse:
motion, flare and a response that differs from frame to frame pass for wrong times. So it is
validated twice: on held-out tiles of the picture, and in the map. Otherwise the stated times stay.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, as_response, as_stack
from hdrlab.diagnostics import flat_patches, response_steps
from hdrlab.diagnostics.doubts import warning_text

# stops: a time that was this far off is more than rough
FAR = 0.5
# stops, of a correction of three times: more is no rounding of a camera's
ROUNDED = 0.08
# stops of bias: times that agree so well are left alone
EXACT = 0.005


class Estimate(NamedTuple):
    """Exposure times by the pixels, and whether to use them.

    Attributes
    ----------
    times : (P,) seconds, to be used: the estimated ones where accepted, else those stated
    stops : (P,), log2(estimated / stated), whether accepted or not
    accepted : whether the estimate is better, by pixels that it was not made from and by the spread
    reason : a sentence, why or why not
    bias_before, bias_after : stops by which pairs of frames disagree in held-out tiles
    spread_before, spread_after : stops, by the caller's `spread`; NaN where it was not asked
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
    """Return the exposure times of a bracket by its pixels where held-out ones confirm them, else as stated.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Aligned photographs, from short to long.
    times : (P,) float
        Stated times in seconds. Their geometric mean stays, and so does their span where g is not
        known: the corrections are orthogonal to 1, and to ln times. But where one of four or more
        is wrong alone, the others stay.
    spread : function, optional
        times -> stops, how far the frames contradict each other in the map that these times make;
        the estimate must not raise it. It is asked only where the held-out pixels agree better.
    g : (n,) or (n, 3) float, optional
        The response, ln exposure, where it is known (a linear camera); otherwise it is fitted as
        well.
    sd : float
        How far a stated time may be off, stops: to this the estimate is shrunk.
    gain : float
        Share by which the bias in held-out tiles must fall.
    valid : (P, H, W) bool, optional
        False where a photograph holds no picture.

    Returns
    -------
    Estimate

    Raises
    ------
    ValueError
        For photographs, times, response or mask that do not fit together, or times that fall.

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
    B, nothing = np.log(times), np.zeros((len(times), 0))
    Q = response_steps.free_directions(B, known=g is not None)
    if g is not None:
        g = as_response(g, 256, stack[0, 0, 0].size).T
    kept = Estimate(times, np.zeros(len(times)), False, "")
    if Q.shape[1] == 0:
        return kept._replace(
            reason="two photographs do not determine both their times and their response"
        )
    found = flat_patches.find_flat_patches(stack, valid=valid)
    H = flat_patches.count_pairs(found.Z, found.best)
    if not response_steps.find_informative(H).any():
        return kept._replace(reason="too few patches are flat in every photograph")
    before = cross_validate(found, B, nothing, g=g, sd=sd)
    kept = kept._replace(bias_before=before)
    if before <= EXACT:
        return kept._replace(reason=f"the stated times agree with the pixels to {before:.3f} stops")
    x = response_steps.fit_steps(H, B, Q, g=g, sd=sd).x
    x = x if g is not None else single_out(x, B)
    after = cross_validate(found, B, Q, g=g, sd=sd)
    kept = kept._replace(stops=x / np.log(2), bias_after=after)
    change = f"from {before:.3f} to {after:.3f} stops"
    if not after <= (1 - gain) * before:
        return kept._replace(reason=f"held-out pixels would agree no better ({change})")
    return _check_spread(kept, np.exp(B + x), change, spread)


def single_out(x: F64, B: F64) -> F64:
    """Return corrections of the same pixels that leave all times but one, where there are such; else x.

    The pixels leave a straight line in B open. Where one time is wrong, x spreads its error over
    all.

    Examples
    --------
    >>> B = np.arange(5.0)
    >>> x = np.array([0, 0, 0, 0, 1]) - 0.2 * B  # the last time is wrong
    >>> single_out(x, B).round(3).tolist()
    [0.0, 0.0, 0.0, 0.0, 1.0]
    """
    r = response_steps.remove_trend(x, B)
    *_, second, largest = np.sort(np.abs(r))
    alone = len(B) > 3 and second < largest / 8 and largest > ROUNDED * np.log(2)
    return r if alone else x


def _check_spread(
    kept: Estimate, times: F64, change: str, spread: Callable[[F64], float] | None
) -> Estimate:
    """Return the Estimate with other times, unless they raise the spread."""
    if spread is not None:
        kept = kept._replace(spread_before=spread(kept.times), spread_after=spread(times))
        spreads = f"from {kept.spread_before:.3f} to {kept.spread_after:.3f} stops"
        if not kept.spread_after <= kept.spread_before:
            return kept._replace(reason=f"the map's spread would rise {spreads}")
    return kept._replace(
        times=times, accepted=True, reason=f"held-out pixels disagree less, {change}"
    )


def cross_validate(
    found: flat_patches.FlatPatches, B: F64, Q: F64, *, g: F64 | None, sd: float
) -> float:
    """Return the mean absolute bias, in stops, of the fit to each half of the flat patches in the other."""
    half = flat_patches.checkerboard(found.flat.shape[1:])
    H = [flat_patches.count_pairs(found.Z, found.best & part) for part in (half, ~half)]
    fits = [response_steps.fit_steps(one, B, Q, g=g, sd=sd) for one in H]
    biases = [
        response_steps.measure_biases(one, B, fit) for one, fit in zip(H[::-1], fits, strict=True)
    ]
    return float(np.nanmean(np.abs(biases))) if np.isfinite(biases).any() else float("nan")


def note(found: Estimate, names: Sequence[str]) -> str:
    """Return the sentence on what was found, with the two largest corrections."""
    if not found.accepted:
        return f"the stated times stay: {found.reason}"
    far = sorted(range(len(names)), key=lambda j: -abs(found.stops[j]))[:2]
    most = ", ".join(f"{names[j]} {found.stops[j]:+.3f}" for j in far)
    count = np.count_nonzero(np.abs(found.stops) > EXACT)
    changed = f"{count} of {len(names)} corrected, most {most} stops"
    return f"times estimated from the pixels: {changed}; {found.reason}"


def doubts(found: Estimate) -> tuple[str, ...]:
    """Return why not to trust estimated times: a sentence, or none."""
    far = float(np.abs(found.stops).max())
    if not found.accepted or far <= (ROUNDED if len(found.stops) == 3 else FAR):
        return ()
    if far <= FAR:
        return (warning_text("one_of_three", middle=1.5 * far, end=3 * far),)
    return (warning_text("far", stops=far),)
