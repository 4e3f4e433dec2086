"""Plot the radiance of one pixel as estimated from each photo.

Z    pixel values           (P,), one of each photo
B    ln exposure times      (P,)
g    response               (n,), ln exposure of each pixel value
w    weights                (n,)
lE   ln E of a photo: g(Z) - B
"""

import numpy as np
from matplotlib.axes import Axes

from hdrlab.core.arrays import Array, ArrayLike, describe
from hdrlab.errors import InputError
from hdrlab.show.plots import BLACK, NARROW_LEGEND, axes, seconds

LN_PER_STOP = np.log(2)
# The y axis shows this many stops on both sides of the middle.
AXIS_LIMIT_STOPS = 12
BOUND_LENGTH_STOPS = 1.6
MEASUREMENT_COLOR = "#0072B2"
BOUND_COLOR = "#E69F00"
MEAN_COLOR = "#D55E00"


def draw_measurements(
    Z: ArrayLike,
    B: ArrayLike,
    g: ArrayLike,
    w: ArrayLike,
    lE: float,
    *,
    top: int = 250,
    middle: float = 0.0,
    truth: float | None = None,
) -> Axes:
    """Draw the radiance of a pixel from each photo: a measurement with its rounding error, or a bound.

    A dot's area is its weight. Pixel value 0 gives an upper bound, and one of `top` or more a lower
    bound, drawn as arrows. `lE` is the merged value, `truth` the true one; `middle` is ln E at 0
    stops.
    """
    Z = np.asarray(Z)
    B = np.asarray(B, np.float64)
    g = np.asarray(g, np.float64)
    w = np.asarray(w, np.float64)
    if Z.ndim != 1 or Z.shape != B.shape or g.ndim != 1 or g.shape != w.shape:
        got = ", ".join(map(describe, (Z, B, g, w)))
        raise InputError(f"expected Z and B (P,), g and w (n,), got {got}")
    ax = axes()
    x = np.arange(len(Z))
    n = len(g)
    ln_low, ln_high = np.interp([Z - 0.5, Z + 0.5], np.arange(n), g)
    stops = (g[Z] - B - middle) / LN_PER_STOP
    low = (ln_low - B - middle) / LN_PER_STOP
    high = (ln_high - B - middle) / LN_PER_STOP
    is_dark = Z == 0
    is_clipped = Z >= top
    is_measured = ~(is_dark | is_clipped)
    ax.vlines(
        x[is_measured],
        low[is_measured],
        high[is_measured],
        color=MEASUREMENT_COLOR,
        linewidth=6,
        alpha=0.35,
    )
    areas = 12 + 110 * w[Z[is_measured]] / w.max()
    ax.scatter(
        x[is_measured], stops[is_measured], s=areas, color=MEASUREMENT_COLOR, label="measured"
    )
    lower_bounds = (g[top] - B[is_clipped] - middle) / LN_PER_STOP
    _draw_bounds(ax, x[is_clipped], lower_bounds, BOUND_LENGTH_STOPS, "^", "at least")
    upper_bounds = (g[1] - B[is_dark] - middle) / LN_PER_STOP
    _draw_bounds(ax, x[is_dark], upper_bounds, -BOUND_LENGTH_STOPS, "v", "at most")
    if truth is not None:
        true_stops = (truth - middle) / LN_PER_STOP
        ax.axhline(true_stops, color=BLACK, linewidth=1.2, linestyle="--", zorder=4, label="truth")
    ax.axhline((lE - middle) / LN_PER_STOP, color=MEAN_COLOR, linewidth=1.6, label="merged")
    ax.set(
        xlim=(-0.6, len(Z) - 0.4),
        ylim=(-AXIS_LIMIT_STOPS, AXIS_LIMIT_STOPS),
        ylabel="radiance, stops from the median",
    )
    tick_labels = [f"{seconds(t)}\n{z}" for t, z in zip(np.exp(B), Z.tolist(), strict=True)]
    ax.set_xticks(x, tick_labels, fontsize=8)
    ax.set_xlabel("exposure time and pixel value", labelpad=1)
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncols=5, **NARROW_LEGEND)
    return ax


def _draw_bounds(ax: Axes, x: Array, bounds: Array, length: float, marker: str, label: str) -> None:
    """Draw bounds as arrows of a length in stops, upward if it is positive."""
    ax.vlines(x, bounds, bounds + length, color=BOUND_COLOR, linewidth=1.6)
    if len(x):
        ax.plot(x, bounds + length, marker, color=BOUND_COLOR, markersize=7, label=label)
