"""Blends of two lights -> matplotlib Axes: the samples on their way onto one curve, and how far it is off.

I, M  samples of a blend  (l,): relative irradiance, in a unit and from a zero of its own; brightness, 0 to 1
s, r  scale and offset    of each blend: s I + r is the exposure of its samples
M, X  inverse response    a `InverseResponse`: exposure X, 0 to 1 over the brightnesses that were measured

Brightness is drawn as a pixel level, 255 M, up; exposure is drawn across, as in the plots of
responses.
"""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from hdrlab.calibration.blends import Blend, InverseResponse, difference
from hdrlab.core.arrays import F64, ArrayLike
from hdrlab.errors import InputError
from hdrlab.show.plots import LINES, SAMPLES, axes, logarithmic, with_legend


def samples(
    blends: Sequence[Blend],
    s: ArrayLike = 1.0,
    r: ArrayLike = 0.0,
    *,
    names: Sequence[str] = (),
    joined: InverseResponse | None = None,
    across: str = "relative irradiance, s I + r",
    scale: str = "linear",
) -> Axes:
    """Draw each blend's samples at (s I + r, 255 M), and the curve that joins them.

    Up to six blends have a colour and a marker each, and those of `names` a label; more are drawn
    alike.
    """
    scales, offsets = (
        np.broadcast_to(np.asarray(one, np.float64), (len(blends),)) for one in (s, r)
    )
    few = len(blends) <= len(SAMPLES)
    ax = axes()
    if joined is not None:  # above the samples, which would hide it
        ax.plot(joined.X, 255 * joined.M, color="#1A1A1A", linewidth=1.5, zorder=3, label="joined")
    for k, (one, own, start) in enumerate(zip(blends, scales, offsets, strict=True)):
        colour, marker = SAMPLES[k] if few else ("#0072B2", ".")
        label = names[k] if k < len(names) else None
        ax.plot(own * one.I + start, 255 * one.M, marker, color=colour, markersize=4, label=label)
    ax.set(xlabel=across, ylabel="pixel level, 255 M", ylim=(-5, 260))
    if scale == "log":
        logarithmic(ax)
    return with_legend(ax, "lower right") if names or joined is not None else ax


def deviations(
    found: Mapping[str, InverseResponse], inverse: Callable[[F64], F64], *, limit: float = 4.0
) -> Axes:
    """Draw how far each curve lies from the camera's own inverse response, in percent of the range.

    Both go from 0 to 1 over the brightnesses measured [Wilburn08 sec. 5], so every line begins and
    ends at 0.
    """
    ax = axes()
    ax.axhline(0, color="#808080", linewidth=1, zorder=1)
    if len(found) >= len(LINES):
        raise InputError(
            f"expected at most {len(LINES) - 1} curves in one picture, got {len(found)}"
        )
    for (colour, style), (name, one) in zip(LINES[1:], found.items(), strict=False):
        off = difference(one, one._replace(X=np.asarray(inverse(one.M), np.float64)))
        ax.plot(255 * one.M, 100 * off, linestyle=style, color=colour, linewidth=1.6, label=name)
    ax.set(xlabel="pixel level, 255 M", ylabel="estimated − true, % of the range")
    ax.set(xlim=(0, 255), ylim=(-limit, limit))
    return with_legend(ax, "upper left")
