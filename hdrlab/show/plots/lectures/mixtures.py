"""Plot calibration by blends of two lights: samples that are joined to one curve, and its error.

I, M  samples of a blend  (l,): relative irradiance, with its own unit and zero; brightness, 0 to 1
s, r  scale and offset    of each blend: s I + r is the exposure of its samples
M, X  inverse response    an `InverseResponse`: exposure X, 0 to 1, of the measured brightnesses M

The y axis is brightness as a pixel value, 255 M; the x axis is exposure, as in plots of responses.
"""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from hdrlab.calibration.blends import Blend, InverseResponse, difference
from hdrlab.core.arrays import F64, ArrayLike
from hdrlab.errors import InputError
from hdrlab.show.plots import BLACK, LINE_STYLES, SAMPLE_STYLES, axes, logarithmic, with_legend


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

    Up to six blends have a color and a marker each, and a label from `names`; more are drawn alike.
    """
    scales = np.broadcast_to(np.asarray(s, np.float64), (len(blends),))
    offsets = np.broadcast_to(np.asarray(r, np.float64), (len(blends),))
    has_own_styles = len(blends) <= len(SAMPLE_STYLES)
    ax = axes()
    if joined is not None:
        above_the_samples = 3
        ax.plot(
            joined.X,
            255 * joined.M,
            color=BLACK,
            linewidth=1.5,
            zorder=above_the_samples,
            label="joined",
        )
    for k, blend in enumerate(blends):
        color, marker = SAMPLE_STYLES[k] if has_own_styles else ("#0072B2", ".")
        label = names[k] if k < len(names) else None
        exposure = scales[k] * blend.I + offsets[k]
        ax.plot(exposure, 255 * blend.M, marker, color=color, markersize=4, label=label)
    ax.set(xlabel=across, ylabel="pixel value, 255 M", ylim=(-5, 260))
    if scale == "log":
        logarithmic(ax)
    if names or joined is not None:
        with_legend(ax, "lower right")
    return ax


def deviations(
    responses: Mapping[str, InverseResponse], inverse: Callable[[F64], F64], *, limit: float = 4.0
) -> Axes:
    """Draw the error of each inverse response in percent of the range.

    The estimates and the camera's own inverse response are both scaled to 0 to 1 over the measured
    brightnesses [Wilburn08 sec. 5], so every line begins and ends at 0.
    """
    ax = axes()
    ax.axhline(0, color="#808080", linewidth=1, zorder=1)
    if len(responses) >= len(LINE_STYLES):
        raise InputError(
            f"expected at most {len(LINE_STYLES) - 1} curves in one plot, got {len(responses)}"
        )
    for (color, style), (name, response) in zip(LINE_STYLES[1:], responses.items(), strict=False):
        truth = response._replace(X=np.asarray(inverse(response.M), np.float64))
        percent = 100 * difference(response, truth)
        ax.plot(255 * response.M, percent, linestyle=style, color=color, linewidth=1.6, label=name)
    ax.set(xlabel="pixel value, 255 M", ylabel="estimated − true, % of the range")
    ax.set(xlim=(0, 255), ylim=(-limit, limit))
    return with_legend(ax, "upper left")
