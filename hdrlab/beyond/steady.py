"""Tone mapping that does not flicker: what a frame is adapted to is taken from its neighbours as well.

E_i    radiance of frame i     (H, W[, 3]) >= 0, any linear unit, the same for all frames
L_i    its luminance           (H, W)
span   frames before and after that count
Lav_i  log average             of all pixels of the frames i - span ... i + span: what frame i is adapted to
a      key                     what Lav becomes, 0.18
white  the brightest scaled luminance, a L / Lav, of these frames: what becomes white
Ld_i   display luminance       (H, W) in [0, 1]
y_i    mean of what stands still in a frame, as it is shown, in display levels, 0 to 255

An operator that adapts to each frame by itself follows its noise, and whatever bright thing comes and goes:
the room gets darker when a lamp enters. [Kang03 sec. 5] lets the photographic operator adapt to a
few frames at once. Any operator with the knobs `key` and `white` of `tonemap.reinhard` serves.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from hdrlab.beyond.neighbours import slide_windows
from hdrlab.core import colour, extremes
from hdrlab.core.arrays import F32, ArrayLike, as_radiance
from hdrlab.errors import InputError

SMALLEST_LUMINANCE = float(np.finfo(np.float32).tiny)


class State(NamedTuple):
    """The display luminance of a frame, and its adaptation.

    Attributes
    ----------
    E : the frame itself, float32
    Ld : (H, W) float32, 0 to 1
    own : log average of the frame by itself
    average : Lav, over the frame and its neighbours
    white : scaled luminance that became white
    """

    E: F32
    Ld: F32
    own: float
    average: float
    white: float


class FrameStatistics(NamedTuple):
    """A frame, its luminance, the mean of ln(delta + L), and its brightest luminance."""

    E: F32
    L: F32
    log: float
    high: float


def measure_frame(E: ArrayLike, *, delta: float = 1e-6) -> FrameStatistics:
    """Return mean(ln(delta + L)), delta in medians of L as in `tonemap.reinhard`, and the brightest L."""
    E = as_radiance(E)
    L = colour.luminance(E)
    floor = max(delta * extremes.robust_maximum(L, cut=0.5), SMALLEST_LUMINANCE)
    mean = float(np.log(L + np.float32(floor)).mean(dtype=np.float64))
    return FrameStatistics(E, L, mean, extremes.robust_maximum(L))


def adapt(window: Sequence[FrameStatistics], *, key: float) -> tuple[float, float]:
    """Return Lav = exp(mean of the frames' logarithms), and white, at least 1  [Kang03 sec. 5]."""
    average = float(np.exp(np.mean([frame.log for frame in window])))
    highs = [max(frame.high, SMALLEST_LUMINANCE) for frame in window]
    high = float(np.exp(np.mean(np.log(highs))))
    return average, max(1.0, key * high / average)


def tonemap_steps(
    frames: Iterable[ArrayLike], operator: Callable[..., F32], *, key: float = 0.18, span: int = 1
) -> Iterator[State]:
    """Yield the tone-mapped State of each frame, adapted over time, as soon as `span` more are there.

    Parameters
    ----------
    frames : radiance (H, W) or (H, W, 3), all in one unit
    operator : operator(L, key=, white=) -> Ld, such as `tonemap.reinhard.tonemap`
    key : the value that the log average becomes
    span : number of frames before and after that are averaged; 0 is each frame by itself

    Raises
    ------
    ValueError
        For frames that are not radiance, a key that is not positive and a negative span.

    References
    ----------
    Kang, Uyttendaele, Winder and Szeliski, High dynamic range video, SIGGRAPH 2003, sec. 5.

    Examples
    --------
    >>> def photographic(L, key, white):
    ...     Lm = key * L / np.exp(np.log(L).mean())
    ...     return Lm / (1 + Lm)
    >>> frames = [np.full((2, 2), level) for level in (1.0, 2.0, 1.0)]
    >>> [round(float(state.Ld.mean()), 3) for state in tonemap_steps(frames, photographic)]
    [0.113, 0.222, 0.113]
    """
    if not 0 < key < np.inf or span < 0:
        raise InputError(f"expected a positive key and a span of at least 0, got {key} and {span}")
    for place, window in slide_windows((measure_frame(E) for E in frames), span):
        frame = window[place]
        average, white = adapt(window, key=key)
        own = float(np.exp(frame.log))
        Ld = operator(frame.L, key=key * own / average, white=white)
        yield State(frame.E, Ld, own, average, white)


def flicker(Ld: Iterable[ArrayLike], still: ArrayLike | None = None) -> float:
    """Return the flicker, the root mean square of (y_(i-1) - 2 y_i + y_(i+1)) / 4, y in levels of 0 to 255.

    y is the mean level of a frame. A steady change has no second difference. A mean that goes up
    and down by a level from frame to frame has a flicker of 1.

    Parameters
    ----------
    Ld : at least three frames (H, W), display luminance, 0 to 1
    still : (H, W) bool, the static part of the scene, which the mean is taken over; everything by
        default. An operator that adapts to each frame keeps the mean of the whole frame, and so
        changes the static part.

    Examples
    --------
    >>> round(flicker(np.full((2, 2), y) for y in (0.1, 0.2, 0.1, 0.2)), 1)
    17.3
    """
    encoded = [colour.encode_srgb(np.asarray(frame, np.float64)) for frame in Ld]
    part = ... if still is None else np.asarray(still, bool)
    y = np.array([255 * float(frame[part].mean()) for frame in encoded])
    if len(y) < 3:
        raise InputError(f"expected at least three frames, got {len(y)}")
    return float(np.sqrt(np.mean((np.diff(y, 2) / 4) ** 2)))
