"""Exposure times from the pixels, where the stated ones are rough.

B       ln stated times   (P,)
x       corrections       (P,), ln(time / stated time), as `steps` fits them: see there, for the gauge too
spread  how far the frames contradict each other in the map that times make, stops: a function of the caller

An estimate fits the pixels that it was made from better than any stated times, and may still be worse:
motion, flare and a response that differs from frame to frame pass for wrong times. So it has to prove itself
twice: on tiles of the picture that it has not seen, and in the map. Otherwise the stated times stay.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core.arrays import Array, as_stack, as_table
from hdrlab.diagnostics.flats import Flats, flats, pair_tables, tiles
from hdrlab.diagnostics.response_steps import ascending, biases, directions, fit, speaking

Float = NDArray[np.float64]
FAR = 0.5  # stops: a time that was this far off is more than rough
EXACT = 0.005  # stops of bias: times that agree so well are left alone


class Estimate(NamedTuple):
    """What the pixels say of the times.

    Attributes
    ----------
    times : (P,) seconds, to be used: the estimated ones where accepted, else those stated
    stops : (P,), log2(estimated / stated), whether accepted or not
    accepted : whether the estimate is better, by pixels that it was not made from and by the spread
    reason : a sentence, why or why not
    bias_before, bias_after : stops by which pairs of frames disagree in held-out tiles
    spread_before, spread_after : stops, as the caller's `spread` says; NaN where it was not asked
    """

    times: Float
    stops: Float
    accepted: bool
    reason: str
    bias_before: float = float("nan")
    bias_after: float = float("nan")
    spread_before: float = float("nan")
    spread_after: float = float("nan")


def estimate(
    images: ArrayLike,
    times: ArrayLike,
    spread: Callable[[Float], float] | None = None,
    *,
    g: ArrayLike | None = None,
    sd: float = 1 / 6,
    gain: float = 0.1,
    valid: ArrayLike | None = None,
) -> Estimate:
    """Return the exposure times of a bracket, as its pixels have them where they prove it, else as stated.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Aligned photographs, from short to long.
    times : (P,) float
        Stated times in seconds. Their geometric mean stays, and so does their span where g is not known: the
        corrections are orthogonal to 1, and to ln times.
    spread : function, optional
        times -> stops, how far the frames contradict each other in the map that these times make; the
        estimate must not raise it. It is asked only where the held-out pixels agree better.
    g : (n,) or (n, 3) float, optional
        The response, ln exposure, where it is known (a linear camera); otherwise it is fitted as well.
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
    >>> from hdrlab.capture.room import scenes
    >>> room = scenes.room((280, 420))
    >>> taken = camera.shoot(room, camera.times_around(room, 5, stops=1.5))
    >>> estimate(taken.images, taken.times * [1, 1, 1.1, 1, 1]).accepted
    True
    """
    stack = as_stack(images)
    times = ascending(times, len(stack))
    B, nothing = np.log(times), np.zeros((len(times), 0))
    Q = directions(B, known=g is not None)
    table = None if g is None else _channels(g, stack)
    kept = Estimate(times, np.zeros(len(times)), False, "")
    if Q.shape[1] == 0:
        return kept._replace(reason="two photographs cannot tell their times from their response")
    found = flats(stack, valid=valid)
    H = pair_tables(found.Z, found.best)
    if not speaking(H).any():
        return kept._replace(reason="too few patches are flat in every photograph")
    x = fit(H, B, Q, g=table, sd=sd).x
    before, after = (held_out(found, B, one, g=table, sd=sd) for one in (nothing, Q))
    kept = kept._replace(stops=x / np.log(2), bias_before=before, bias_after=after)
    if before <= EXACT:
        return kept._replace(reason=f"the stated times agree with the pixels to {before:.3f} stops")
    change = f"from {before:.3f} to {after:.3f} stops"
    if not after <= (1 - gain) * before:
        return kept._replace(reason=f"held-out pixels would agree no better ({change})")
    return _judged(kept, np.exp(B + x), change, spread)


def _judged(kept: Estimate, times: Float, change: str, spread: Callable[[Float], float] | None) -> Estimate:
    """Return the Estimate with other times, unless they raise the spread."""
    if spread is not None:
        kept = kept._replace(spread_before=spread(kept.times), spread_after=spread(times))
        spreads = f"from {kept.spread_before:.3f} to {kept.spread_after:.3f} stops"
        if not kept.spread_after <= kept.spread_before:
            return kept._replace(reason=f"the map's spread would rise {spreads}")
    return kept._replace(times=times, accepted=True, reason=f"held-out pixels disagree less, {change}")


def _channels(g: ArrayLike, stack: Array) -> Float:
    """Return a known response as (C, 256)."""
    table = as_table(g, 256).reshape(256, -1).T
    return np.broadcast_to(table, (stack[0, 0, 0].size, 256))


def held_out(found: Flats, B: Float, Q: Float, **knobs: Any) -> float:
    """Return the mean absolute bias, in stops, of each half's Fit in the other half's flat patches."""
    half = tiles(found.flat.shape)
    seen = []
    for mine in (half, ~half):
        own = fit(pair_tables(found.Z, found.best & mine), B, Q, **knobs)
        seen.append(biases(pair_tables(found.Z, found.best & ~mine), B, own))
    return float(np.nanmean(np.abs(seen))) if np.isfinite(seen).any() else float("nan")


def note(found: Estimate, names: Sequence[str]) -> str:
    """Return the sentence on what was found, frame by frame where the times were changed."""
    if not found.accepted:
        return f"the stated times stay: {found.reason}"
    frames = ", ".join(f"{name} {by:+.3f}" for name, by in zip(names, found.stops, strict=True))
    return (
        f"times estimated from the pixels, stops against those stated: {frames}; {found.reason}, "
        f"and the map's spread falls from {found.spread_before:.3f} to {found.spread_after:.3f}"
    )


def doubts(found: Estimate) -> tuple[str, ...]:
    """Return why not to trust estimated times: a sentence, or none."""
    far = float(np.abs(found.stops).max())
    if not found.accepted or far <= FAR:
        return ()
    return (
        f"the estimated times depart from those stated by up to {far:.2f} stops: the frames now agree, but "
        "the span of the times, and with it the contrast of the map, is only as true as the stated ones are",
    )
