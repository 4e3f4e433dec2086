"""Radiance of one pixel by each photograph -> matplotlib Axes.

Z    levels of a pixel      (P,), one of each photograph
B    ln exposure times      (P,)
g    response               (n,), ln exposure of each level
w    weights                (n,)
lE   ln E of a photograph: g(Z) - B
"""

import numpy as np
from matplotlib.axes import Axes

from hdrlab.core.arrays import ArrayLike, describe
from hdrlab.errors import InputError
from hdrlab.show.plots import NARROW, axes, seconds

STOP = np.log(2)
# stops: how far a measurement may lie from the middle, and still be shown
REACH = 12
MEASURED = "#0072B2"
BOUND = "#E69F00"
MEAN = "#D55E00"
TRUE = "#1A1A1A"


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
    """Draw the radiance of a pixel by each photograph: a measurement with the width of its level, or a bound.

    A dot's area is its weight. Level 0 means "at most" and a level of `top` or more "at least",
    drawn as arrows. `lE` is the merged value, `truth` the true one; `middle` is ln E at 0 stops.
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
    ends = np.interp([Z - 0.5, Z + 0.5], np.arange(n), g)
    here, low, high = ((one - B - middle) / STOP for one in (g[Z], *ends))
    dark = Z == 0
    clipped = Z >= top
    whole = ~(dark | clipped)
    ax.vlines(x[whole], low[whole], high[whole], color=MEASURED, linewidth=6, alpha=0.35)
    ax.scatter(
        x[whole], here[whole], s=12 + 110 * w[Z[whole]] / w.max(), color=MEASURED, label="measured"
    )
    for at, level, way, mark, name in (
        (clipped, top, 1, "^", "at least"),
        (dark, 1, -1, "v", "at most"),
    ):
        bound = (g[level] - B[at] - middle) / STOP
        ax.vlines(x[at], bound, bound + way * 1.6, color=BOUND, linewidth=1.6)
        if at.any():
            ax.plot(x[at], bound + way * 1.6, mark, color=BOUND, markersize=7, label=name)
    if truth is not None:
        at = (truth - middle) / STOP
        ax.axhline(at, color=TRUE, linewidth=1.2, linestyle="--", zorder=4, label="truth")
    ax.axhline((lE - middle) / STOP, color=MEAN, linewidth=1.6, label="merged")
    ax.set(
        xlim=(-0.6, len(Z) - 0.4), ylim=(-REACH, REACH), ylabel="radiance, stops from the median"
    )
    ax.set_xticks(
        x, [f"{seconds(t)}\n{z}" for t, z in zip(np.exp(B), Z.tolist(), strict=True)], fontsize=8
    )
    ax.set_xlabel("exposure time, and the pixel's level", labelpad=1)
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncols=5, **NARROW)
    return ax
