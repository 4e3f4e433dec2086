"""The response of a bracket: by a method of `response`, by a function of the reader's, or "auto".

For "auto" held-out pixels choose, and of two that explain them alike, the simpler is taken. A
neutral surface has one level in all channels, and so should have one radiance. Three curves, each
recovered by itself, disagree where few frames leave them open, and a gray wall gets coloured
patches. One curve for all channels cannot. Cameras have one, as a rule; scanned film has three. So
one curve is taken where it explains pixels that it was not recovered from nearly as well as three
do, by `consistency.measure_spread` of each channel.

A map needs some response. So where a method finds none, or one that no camera has, one that a prior
settles takes its place, with a doubt: that of `response.space`.
"""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from hdrlab.core import metrics, sampling, weights
from hdrlab.core.arrays import F64, ArrayLike, Indices, as_mask, as_stack
from hdrlab.core.bracket import Bracket
from hdrlab.diagnostics import consistency, doubts, plausibility
from hdrlab.errors import InputError
from hdrlab.fast import debevec, merge, robertson
from hdrlab.pipeline import catalogue
from hdrlab.pipeline.assembly import Method
from hdrlab.response import self_calibration, space

Recover = Callable[..., F64]
# pixels of a frame, on an even grid; every other stripe is held out
PIXELS, STRIPES = 2**16, 20
# how much more spread one curve for all channels may leave: a share, and stops
SLACK, FINEST = 0.05, 0.003
# levels in a row that smoothness alone connects
WIDEST_GAP = 20
# samples that show which levels two frames share
SAMPLES = 1000


class Choice(NamedTuple):
    """A method, the spread in stops that it leaves in held-out pixels, and notes on it."""

    method: Recover
    spread: float
    notes: tuple[str, ...] = ()


def find_method(response: Method) -> Recover:
    """Return a method by its name, EXTENDED where it is; a function is taken as it is."""
    return EXTENDED.get(response) or catalogue.method("response", response)


def find_validated_method(response: Method) -> Recover:
    """Return `recover(images, times, *, valid) -> g`, which refuses a response that the images contradict.

    A function is taken as it is, and so is "linear", which does not ask the images.
    """
    found = find_method(response)
    return found if callable(response) or response == "linear" else partial(_recover, found)


def _recover(
    method: Recover, images: ArrayLike, times: ArrayLike, *, valid: ArrayLike | None = None
) -> F64:
    """Return the response that a method finds, or raise a ValueError: see `validate_response`."""
    return plausibility.validate_response(
        method(images, times, valid=valid), images, times, valid=valid
    )


def share_curve(method: Recover) -> Recover:
    """Return a method that recovers one curve from the levels of all channels together."""

    def recover(images: ArrayLike, times: ArrayLike, *, valid: ArrayLike | None = None) -> F64:
        stack = as_stack(images)
        mask, shape = as_mask(valid, stack), stack.shape[3:]
        shown = None if mask is None else np.repeat(mask, np.prod(shape, dtype=int), axis=2)
        g = method(stack.reshape(*stack.shape[:2], -1), times, valid=shown)
        return np.multiply.outer(g, np.ones(shape))

    return recover


# methods that need more than their paper for photographs as people take them
EXTENDED: dict[Method, Recover] = {
    "robertson": partial(robertson.recover, steps=robertson.Smooth(100)),
    "mitsunaga": self_calibration.find_response,
}
CANDIDATES: dict[str, Recover] = {  # three curves first, which set the spread to compare with
    "a curve for each channel by debevec": debevec.recover,
    "a curve for each channel by space": space.recover,
    "one curve by space": share_curve(space.recover),
    "one curve by debevec": share_curve(debevec.recover),
}


def split_stripes(bracket: Bracket) -> tuple[Bracket, Bracket]:
    """Return every other stripe of a bracket, thinned to PIXELS, and those between."""
    images, _, _, valid, _ = bracket
    height, width = images.shape[1:3]
    step = max(1, int(np.sqrt(height * width / PIXELS)))
    rows = np.arange(0, height, step)
    odd = rows * STRIPES // height % 2 == 1

    def keep(own: Indices) -> Bracket:
        shown = None if valid is None else valid[:, own, ::step]
        return bracket._replace(images=images[:, own, ::step], valid=shown)

    return keep(rows[~odd]), keep(rows[odd])


def find_widest_gap(Z: ArrayLike) -> int:
    """Return how many levels in a row, of those that samples Z (N, P) show, no sample shows in two frames.

    Examples
    --------
    >>> find_widest_gap([[100, 200], [101, 201], [20, 255]])  # 20 stands in one frame alone
    99
    """
    Z = np.asarray(Z)
    inside = (Z >= metrics.LOW_LEVEL) & (Z <= metrics.HIGH_LEVEL)
    shared, shown = Z[inside & (inside.sum(axis=1, keepdims=True) > 1)], Z[inside]
    if not len(shown):
        return 256
    return int(np.diff(np.unique([shown.min(), *shared, shown.max()])).max(initial=1))


def measure_spread(method: Recover, fit: Bracket, held: Bracket) -> float:
    """Return the spread in stops that a method's response leaves in held-out pixels; inf if there is none.

    It is the mean of the channels' spreads: the median over all levels hides a curve that one
    channel denies.
    """
    try:
        g = method(fit.images, fit.times, valid=fit.valid)
    except ValueError:
        return np.inf
    E = merge.merge_with_quality(
        held.images, held.times, g, weights.gaussian(len(g)), valid=held.valid
    ).E
    medians = consistency.measure_level_exposures(held.images, held.times, E, valid=held.valid)
    spreads = [consistency.measure_spread(one[:, None]) for one in medians.swapaxes(0, 1)]
    return float(np.nan_to_num(np.mean(spreads), nan=np.inf))


def choose_response(response: Method, bracket: Bracket) -> Choice:
    """Return the Choice for an aligned bracket: what "auto" stands for, or the method that was named.

    Debevec's curve does not count where smoothness alone connects its levels: a prior settles them.
    Where nothing can be compared it is taken.
    """
    fit, held = split_stripes(bracket)
    if response != "auto" or bracket.linear:
        method = find_validated_method("linear" if response == "auto" else response)
        return Choice(method, measure_spread(method, fit, held))
    Z = sampling.by_rank(fit.images, SAMPLES, valid=fit.valid).reshape(SAMPLES, len(fit.times), -1)
    open_levels = any(find_widest_gap(Z[..., c]) > WIDEST_GAP for c in range(Z.shape[-1]))
    name, enough, spreads = "", np.inf, {}
    for one, method in CANDIDATES.items():
        separate = not one.startswith("one")
        if (open_levels and "debevec" in one) or (separate and np.isfinite(enough)):
            continue
        spreads[one] = measure_spread(partial(_recover, method), fit, held)
        if spreads[one] < np.inf and spreads[one] <= enough:
            name, enough = one, (1 + SLACK) * spreads[one] + FINEST
            if not separate:
                break
    if not name:
        return Choice(find_validated_method("debevec"), np.inf)
    compared = ", ".join(f"{one} {spread:.3f}" for one, spread in spreads.items())
    said = f"response: {name}, chosen by the spread that each leaves in held-out pixels, in stops: {compared}"
    return Choice(partial(_recover, CANDIDATES[name]), spreads[name], (said,))


def find_response(
    response: Method, choice: Choice, bracket: Bracket
) -> tuple[F64, tuple[str, ...], str]:
    """Return the response of an aligned bracket, doubts about it, and why it is worth no map, or "".

    Raises
    ------
    ValueError
        For photographs of which no two see anything well, and what a reader's own function raises.
    """
    images, times, _, valid, _ = bracket
    try:
        return choice.method(images, times, valid=valid), (), ""
    except ValueError as error:
        if callable(response):
            raise
        said = f"no response was found ({error}), so that of the likeliest camera was taken: check the times"
    try:
        g = space.recover(images, times, valid=valid)
    except ValueError as error:
        raise InputError(doubts.say("in_common", error=error)) from None
    try:
        return plausibility.validate_response(g, images, times, valid=valid), (said,), ""
    except ValueError:
        return g, (said,), said
