"""High dynamic range video from alternating exposures (Kang et al., SIGGRAPH 2003).

Z_i    frame i        (H, W[, 3]) levels, of exposure time t_i, s: short, long, short, ...
g      response       (n[, 3]), ln exposure of each level
v_i    frame i        (H, W, C), in values, see `ldr_values`
R_i    radiance       (H, W, C), from frame i alone, exp g(Z_i) / t_i
f_W    weight         w(Z_i), of each pixel and channel, 0 where it is clipped or black
f_MW   consistency    (H, W, 1), 0 to 1: 0 where a neighbour, warped to frame i, contradicts it
alpha  exposure       (H, W, 1), 1 where frame i is well exposed, 0 where it is clipped or black
U      along          neighbours i - 1 and i + 1 warped to frame i, along the flow from i (unidirectional)
B      between        the same, warped half-way to each other (bidirectional)

Each frame has one exposure, and its neighbours, a moment earlier and later, fill what it lacks.
Where frame i is well exposed, its neighbours are boosted to its exposure, and warped along the
optical flow. Where it is not, there is no flow; but both neighbours have the same exposure, and the
moment of frame i is half-way between theirs.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import cycle
from typing import NamedTuple

import numpy as np

from hdrlab.beyond import ldr_values, neighbours, synthesis
from hdrlab.beyond.flow import Flow, halve_flow, lands_inside, tvl1, warp
from hdrlab.core import weights
from hdrlab.core.arrays import F32, Array, ArrayLike, Mask, as_table, as_times, levels
from hdrlab.errors import InputError

# difference of values; a neighbour that differs more has no weight
VALUE_TOLERANCE = np.float32(16 / 255)
# of B: if all frames are clipped, the shorter exposure is the better bound
MIN_WEIGHT = np.float32(1e-4)
# levels, 1 is the top: the exposedness of a frame rises over the first range, and falls over the second
EXPOSED_LEVELS: tuple[synthesis.Ramp, synthesis.Ramp] = ((0.02, 0.1), (0.85, 0.95))


@dataclass(frozen=True)
class Frame:
    """A frame of the video, with arrays (H, W, C).

    Attributes
    ----------
    v : values
    noise : change of the values by one level
    clipped : bool
    R : radiance from this frame alone
    w : weight f_W
    alpha : (H, W, 1), 1 where the frame is well exposed
    t : exposure time, seconds
    full : (C,), exposure of a full pixel
    """

    v: F32
    noise: F32
    clipped: Mask
    R: F32
    w: F32
    alpha: F32
    t: float
    full: F32


class Term(NamedTuple):
    """The contribution of a neighbour to frame i: radiance R and weight w, (H, W, C)."""

    R: F32
    w: F32


class State(NamedTuple):
    """The result for one frame.

    Attributes
    ----------
    frame : number of the frame, from 0
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
    boosted_a = ldr_values.boost(a.v, longer / a.t).mean(axis=-1)
    boosted_b = ldr_values.boost(b.v, longer / b.t).mean(axis=-1)
    return flow(boosted_a, boosted_b)


def warp_frame(frame: Frame, u: F32) -> Term:
    """Return a frame warped along a flow; it has no weight where that leads out of the picture."""
    return Term(warp(frame.R, u), warp(frame.w, u) * lands_inside(u)[..., None])


def consistency(v: F32, v_: F32) -> F32:
    """Return f_MW = 2 d^3 - 3 d^2 + 1, d the channels' greatest difference in 16 / 255, at most 1."""
    d = np.minimum(np.abs(v - v_).max(axis=-1, keepdims=True) / VALUE_TOLERANCE, 1)
    return (2 * d - 3) * d * d + 1


def weigh_neighbour(i: Frame, term: Term) -> Term:
    """Return a neighbour weighted by f_W f_MW alpha: as far as frame i is well exposed and agrees."""
    f_MW = consistency(i.v, ldr_values.expose(term.R, i.t, i.full))
    return Term(R=term.R, w=term.w * f_MW * i.alpha)


def warp_half_way(a: Frame, b: Frame, flow: Flow) -> tuple[Term, ...]:
    """Return both frames warped to the moment half-way between them, and trusted where they agree there."""
    to_a, to_b = halve_flow(estimate_motion(a, b, flow))
    term_a = warp_frame(a, to_a)
    term_b = warp_frame(b, to_b)
    longer = max(a.t, b.t)
    v_a = ldr_values.expose(term_a.R, longer, a.full)
    v_b = ldr_values.expose(term_b.R, longer, a.full)
    f_MW = np.maximum(consistency(v_a, v_b), 0.01)
    return Term(term_a.R, term_a.w * f_MW), Term(term_b.R, term_b.w * f_MW)


def clip_to_frame(i: Frame, R: F32) -> tuple[F32, F32]:
    """Return R clipped to the range that frame i allows, and f_MW (H, W, 1) of the change.

    Frame i allows R_i and more where it is clipped, and values within a few levels of R_i
    elsewhere.
    """
    low, high = ldr_values.consistent_range(i.v, i.noise, i.clipped, i.t, i.full)
    clipped = np.clip(R, low, high)
    v = ldr_values.expose(R, i.t, i.full)
    v_clipped = ldr_values.expose(clipped, i.t, i.full)
    return clipped, consistency(v_clipped, v)


def blend_terms(i: Frame, along: Iterable[Term], between: Iterable[Term]) -> F32:
    """Return (f_W R_i + sum U + (1 - alpha) sum B) / (f_W + ...), each R times its weight [Kang03 sec. 4].

    B has weight as far as frame i allows it: a badly exposed pixel is still an upper or lower
    bound.
    """
    terms = [Term(i.R, i.w), *along]
    for term in between:
        _, f_MW = clip_to_frame(i, term.R)
        terms.append(Term(term.R, (1 - i.alpha) * np.maximum(f_MW * term.w, MIN_WEIGHT)))
    total = np.sum([term.w for term in terms], axis=0)
    mean = np.sum([term.w * term.R for term in terms], axis=0) / np.where(total > 0, total, 1)
    E, _ = clip_to_frame(i, np.where(total > 0, mean, i.R))
    return E


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
    cycle_times = np.atleast_1d(np.asarray(times, np.float64))
    cycle_times = as_times(cycle_times, max(cycle_times.size, 1))
    pairs = zip(frames, cycle(cycle_times), strict=False)
    checked = require_one_size(as_frame(Z, float(t), g, w) for Z, t in pairs)
    for number, (place, window) in enumerate(neighbours.slide_windows(checked, 1)):
        i = window[place]
        others = [*window[:place], *window[place + 1 :]]
        warped = [warp_frame(j, estimate_motion(i, j, flow)) for j in others]
        between = tuple(warped)
        if len(others) == 2:
            between = warp_half_way(others[0], others[1], flow)
        along = tuple(weigh_neighbour(i, term) for term in warped)
        E = blend_terms(i, along, between)
        if E.shape[-1] == 1:
            E = E[..., 0]
        yield State(number, E, i.R, along, between, i.alpha)


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
        Exposure times of one cycle in seconds; the cycle is repeated.
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
    maps = [state.E for state in merge_steps(frames, times, g, w, flow=flow)]
    if not maps:
        raise InputError("expected at least one frame, got none")
    return np.stack(maps)


def as_frame(Z: ArrayLike, t: float, g: ArrayLike, w: ArrayLike | None) -> Frame:
    """Return a checked photograph as a Frame."""
    stack = np.asarray(Z)[None]
    values = ldr_values.as_values(stack, [t], g)
    n = levels(stack)
    table = as_table(weights.cut(weights.snr(as_table(g, n))) if w is None else w, n)
    f_W = table.astype(np.float32)[stack.reshape(values.v.shape)][0]
    rising, falling = EXPOSED_LEVELS
    return Frame(
        v=values.v[0],
        noise=values.noise[0],
        clipped=values.clipped[0],
        R=ldr_values.radiance(values.v[0], t, values.full),
        w=f_W,
        alpha=synthesis.trapezoid(values.z[0], rising, falling),
        t=t,
        full=values.full,
    )


def require_one_size(frames: Iterable[Frame]) -> Iterator[Frame]:
    """Yield the frames; raise a ValueError at one that is not of the first one's size."""
    first = None
    for number, frame in enumerate(frames):
        if first is None:
            first = frame
        if frame.v.shape != first.v.shape:
            got = f"{first.v.shape} and, number {number + 1}, {frame.v.shape}"
            raise InputError(f"expected frames of one size, got {got}")
        yield frame
