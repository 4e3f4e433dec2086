"""High dynamic range video from exposures that take turns (Kang et al., SIGGRAPH 2003).

Z_i    frame i        (H, W[, 3]) levels, of exposure time t_i, s: short, long, short, ...
g      response       (n[, 3]), ln exposure of each level
v_i    frame i        (H, W, C), in values, see `ldr_values`
R_i    radiance       (H, W, C), what frame i says, exp g(Z_i) / t_i
f_W    weight         w(Z_i), of each pixel and channel, 0 where it is clipped or black
f_MW   consistency    (H, W, 1), 0 to 1: 0 where a neighbour, warped to frame i, contradicts it
alpha  exposure       (H, W, 1), 1 where frame i is well exposed, 0 where it is clipped or black
U      along          neighbours i - 1 and i + 1 warped to frame i, along the flow from i (unidirectional)
B      between        the same, warped half-way to each other (bidirectional)

Each frame has one exposure, and what it lacks its neighbours have, a moment earlier and later.
Where frame i is well exposed, its neighbours are boosted to its exposure and followed. Where it is
not there is nothing to follow; but the neighbours are exposed alike, and half-way between their
moments lies that of frame i.
"""

from collections.abc import Iterable, Iterator
from itertools import cycle
from typing import NamedTuple

import numpy as np

from hdrlab.beyond import ldr_values, neighbours, synthesis
from hdrlab.beyond.flow import Flow, halve_flow, lands_inside, tvl1, warp
from hdrlab.core import weights
from hdrlab.core.arrays import F32, Array, ArrayLike, Mask, as_table, as_times, levels
from hdrlab.errors import InputError

# of values: a neighbour that is farther off counts for nothing
VALUE_TOLERANCE = np.float32(16 / 255)
# weight of B at least: where all are clipped, the shorter one is the better bound
LEAST_WEIGHT = np.float32(1e-4)
# levels, 1 the top, between which a frame begins to be well exposed, and ceases to be
EXPOSED_LEVELS: tuple[synthesis.Ramp, synthesis.Ramp] = ((0.02, 0.1), (0.85, 0.95))


class Frame(NamedTuple):
    """One frame: v, its noise, where it is clipped, R, f_W, all (H, W, C), alpha, t, and full (C,)."""

    v: F32
    noise: F32
    clipped: Mask
    R: F32
    w: F32
    alpha: F32
    t: float
    full: F32


class Term(NamedTuple):
    """What a neighbour brings to frame i: radiance R and weight w, (H, W, C)."""

    R: F32
    w: F32


class State(NamedTuple):
    """A frame that is done.

    Attributes
    ----------
    frame : which, from 0
    E : (H, W[, 3]), radiance
    alone : (H, W, C), radiance of the frame by itself
    along : U, its neighbours warped to it, one where there is one
    between : B, two; at either end the one neighbour, warped to the frame
    alpha : (H, W, 1)
    """

    frame: int
    E: F32
    alone: F32
    along: tuple[Term, ...]
    between: tuple[Term, ...]
    alpha: F32


def estimate_motion(a: Frame, b: Frame, flow: Flow) -> F32:
    """Return the flow from a to b, the shorter exposure boosted to the longer one [Kang03 sec. 4]."""
    longer = max(a.t, b.t)
    return flow(*(ldr_values.boost(one.v, longer / one.t).mean(axis=-1) for one in (a, b)))


def warp_frame(frame: Frame, u: F32) -> Term:
    """Return a frame warped along a flow; it has no weight where that leads out of the picture."""
    return Term(warp(frame.R, u), warp(frame.w, u) * lands_inside(u)[..., None])


def consistency(v: F32, v_: F32) -> F32:
    """Return f_MW = 2 d^3 - 3 d^2 + 1, d the channels' greatest difference in 16 / 255, at most 1."""
    d = np.minimum(np.abs(v - v_).max(axis=-1, keepdims=True) / VALUE_TOLERANCE, 1)
    return (2 * d - 3) * d * d + 1


def weigh_neighbour(i: Frame, term: Term) -> Term:
    """Return a neighbour weighted by f_W f_MW alpha: as far as frame i is well exposed and agrees."""
    return term._replace(
        w=term.w * consistency(i.v, ldr_values.expose(term.R, i.t, i.full)) * i.alpha
    )


def warp_half_way(a: Frame, b: Frame, flow: Flow) -> tuple[Term, ...]:
    """Return both frames warped to the moment half-way between them, and trusted where they agree there."""
    terms = [
        warp_frame(*each)
        for each in zip((a, b), halve_flow(estimate_motion(a, b, flow)), strict=True)
    ]
    longer = max(a.t, b.t)
    agree = consistency(*(ldr_values.expose(term.R, longer, a.full) for term in terms))
    return tuple(term._replace(w=term.w * np.maximum(agree, 0.01)) for term in terms)


def clip_to_frame(i: Frame, R: F32) -> tuple[F32, F32]:
    """Return R kept within what frame i allows, and f_MW (H, W, 1) of how far it had to be moved for that.

    Frame i allows at least R_i where it is clipped, and what lies within a few levels of R_i
    elsewhere.
    """
    kept = np.clip(R, *ldr_values.consistent_range(i.v, i.noise, i.clipped, i.t, i.full))
    return kept, consistency(
        ldr_values.expose(kept, i.t, i.full), ldr_values.expose(R, i.t, i.full)
    )


def blend_terms(i: Frame, along: Iterable[Term], between: Iterable[Term]) -> F32:
    """Return (f_W R_i + sum U + (1 - alpha) sum B) / (f_W + ...), each R times its weight [Kang03 sec. 4].

    B is asked whether frame i allows it: a badly exposed pixel still says "at least" or "at most".
    """
    half = [
        (R, (1 - i.alpha) * np.maximum(clip_to_frame(i, R)[1] * w, LEAST_WEIGHT))
        for R, w in between
    ]
    terms = [(i.R, i.w), *along, *half]
    total = np.sum([w for _, w in terms], axis=0)
    mean = np.sum([w * R for R, w in terms], axis=0) / np.where(total > 0, total, 1)
    return clip_to_frame(i, np.where(total > 0, mean, i.R))[0]


def merge_steps(
    frames: Iterable[ArrayLike],
    times: ArrayLike,
    g: ArrayLike,
    w: ArrayLike | None = None,
    *,
    flow: Flow = tvl1,
) -> Iterator[State]:
    """Yield the State of each frame as soon as the next one is there; the parameters are those of `merge`.

    Frames may come from a generator: three at a time are held.
    """
    turn = np.atleast_1d(np.asarray(times, np.float64))
    turn = as_times(turn, max(turn.size, 1))
    pairs = zip(frames, cycle(turn), strict=False)
    sized = require_one_size(as_frame(Z, float(t), g, w) for Z, t in pairs)
    for number, (place, window) in enumerate(neighbours.slide_windows(sized, 1)):
        i = window[place]
        beside = [*window[:place], *window[place + 1 :]]
        there = [warp_frame(j, estimate_motion(i, j, flow)) for j in beside]
        between = warp_half_way(beside[0], beside[1], flow) if len(beside) == 2 else tuple(there)
        along = tuple(weigh_neighbour(i, term) for term in there)
        E = blend_terms(i, along, between)
        yield State(number, E if E.shape[-1] > 1 else E[..., 0], i.R, along, between, i.alpha)


def merge(
    frames: Iterable[ArrayLike],
    times: ArrayLike,
    g: ArrayLike,
    w: ArrayLike | None = None,
    *,
    flow: Flow = tvl1,
) -> Array:
    """Return the radiance of every frame of a video whose exposures take turns.

    Parameters
    ----------
    frames : T frames (H, W) or (H, W, 3), uint8 or uint16
        In the order of time; each is best between two of one other exposure.
    times : numbers
        Exposure times, seconds, of one turn: they are repeated for as long as there are frames.
    g : (n,) or (n, 3) float
        Response, ln exposure of each level.
    w : (n,) float, optional
        Weights f_W; signal over noise by default, 0 above the cut.
    flow : function
        (a, b) -> (2, H, W), for which a(p) is b(p + flow); another one may be put in its place.

    Returns
    -------
    E : (T, H, W) or (T, H, W, 3) float32
        In the unit of `radiance.merge`.

    Raises
    ------
    ValueError
        For frames that are not photographs of one size, times that are not positive, and none of
        either.

    References
    ----------
    Kang, Uyttendaele, Winder and Szeliski, High dynamic range video, SIGGRAPH 2003.

    Examples
    --------
    >>> g = np.log(np.maximum(np.arange(256), 0.5) / 128)
    >>> frames = [np.full((16, 16), level, np.uint8) for level in (32, 128, 32)]
    >>> bool(np.allclose(merge(frames, [1, 4], g), 32 / 128, rtol=1e-3))
    True
    """
    found = [state.E for state in merge_steps(frames, times, g, w, flow=flow)]
    if not found:
        raise InputError("expected at least one frame, got none")
    return np.stack(found)


def as_frame(Z: ArrayLike, t: float, g: ArrayLike, w: ArrayLike | None) -> Frame:
    """Return one photograph as a Frame, checked."""
    stack = np.asarray(Z)[None]
    values = ldr_values.as_values(stack, [t], g)
    n = levels(stack)
    table = as_table(weights.cut(weights.snr(as_table(g, n))) if w is None else w, n)
    f_W = table.astype(np.float32)[stack.reshape(values.v.shape)][0]
    R = ldr_values.radiance(values.v[0], t, values.full)
    alpha = synthesis.trapezoid(values.z[0], *EXPOSED_LEVELS)
    return Frame(values.v[0], values.noise[0], values.clipped[0], R, f_W, alpha, t, values.full)


def require_one_size(frames: Iterable[Frame]) -> Iterator[Frame]:
    """Yield the frames; raise a ValueError at one that is not of the first one's size."""
    first = None
    for number, frame in enumerate(frames):
        first = frame if first is None else first
        if frame.v.shape != first.v.shape:
            got = f"{first.v.shape} and, number {number + 1}, {frame.v.shape}"
            raise InputError(f"expected frames of one size, got {got}")
        yield frame
