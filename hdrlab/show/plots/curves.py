"""Labelled curves -> matplotlib Axes: responses, and what one asks of them, in the look of `show.plots`.

x        places         (K,), shared by all curves of a picture
curves   what is shown  label -> (K,)
g        response       (256,), ln exposure of each level;  truth, the camera's own
M        brightness     (N, P), 0 ... 1: sample p in frame q, frames from short to long;  f(M), its exposure
R        ratios         (P - 1,), exposure of a frame over that of the next longer one

Colours and line styles differ together, so that a reader who sees no colours can follow a curve
too.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from hdrlab.core.arrays import ArrayLike, describe
from hdrlab.core.metrics import RELIABLE_LEVELS
from hdrlab.errors import InputError
from hdrlab.show.plots import (
    LINES,
    NARROW,
    SAMPLES,
    Ends,
    axes,
    fix_limits,
    logarithmic,
    with_legend,
)


def lines(
    x: ArrayLike,
    curves: Mapping[str, ArrayLike],
    *,
    across: str,
    up: str,
    limits: Ends = None,
    scale: str = "linear",
    legend: Any = "best",
    ax: Axes | None = None,
) -> Axes:
    """Draw up to six curves over x, each with its label: the first is black, what the others are held to.

    `limits` fix the ends of y, so that a slider moves the curves and nothing else; on an `ax` that
    has curves the colours go on from there.
    """
    x = np.asarray(x, np.float64)
    ax = ax or axes()
    begun = len(ax.lines)
    if begun + len(curves) > len(LINES):
        raise InputError(
            f"expected at most {len(LINES)} curves in one picture, got {begun + len(curves)}"
        )
    for (colour, style), (label, y) in zip(LINES[begun:], curves.items(), strict=False):
        if np.shape(y) != x.shape:
            raise InputError(f"expected {label} at the {x.shape} places, got {describe(y)}")
        ax.plot(x, y, linestyle=style, color=colour, linewidth=1.8, label=label)
    ax.set(xlabel=across, ylabel=up)
    fix_limits(ax, None, limits)
    if scale == "log":
        logarithmic(ax, "y", _short)
    return with_legend(ax, legend)


def _short(x: float, _: object) -> str:
    """Return a power of ten in five letters at most: more would reach into the axis's name."""
    return f"{x:g}" if x >= 1e-3 else f"{x:.0e}"


def deviations(
    found: Mapping[str, ArrayLike], truth: ArrayLike, *, limit: float = 0.5, span: Ends = None
) -> Axes:
    """Draw how many stops each g found lies above the true one, over exposure, at the levels 10 to 250.

    `limit` and `span` fix the axes, as in `lines`.
    """
    stops = np.asarray(truth, np.float64)[RELIABLE_LEVELS] / np.log(2)
    off = {name: np.asarray(g)[RELIABLE_LEVELS] / np.log(2) - stops for name, g in found.items()}
    ax = axes()
    ax.axhline(0, color="#808080", linewidth=1, zorder=1)
    for (colour, style), (name, y) in zip(LINES[1:], off.items(), strict=False):
        ax.plot(stops, y, linestyle=style, color=colour, linewidth=1.6, label=name)
    ax.set(xlabel="true exposure, stops from that of level 128", ylabel="estimated − true, stops")
    fix_limits(ax, span, (-limit, limit))
    return with_legend(ax, "upper left")


def bundle(x: ArrayLike, many: ArrayLike, *, label: str, across: str, up: str) -> Axes:
    """Draw many curves (C, K) thin and alike, as a ground for a few with a name."""
    many = np.atleast_2d(many)
    ax = axes()
    paths = [np.column_stack([x, y]) for y in many]
    ax.add_collection(
        LineCollection(paths, colors="#56B4E9", linewidths=0.5, alpha=0.7, label=label)
    )
    ax.autoscale_view()
    ax.set(xlabel=across, ylabel=up)
    return with_legend(ax, "upper left")


def quotients(M: ArrayLike, fM: ArrayLike, R: ArrayLike) -> Axes:
    """Draw f(M_q) / f(M_q+1) of each two frames over M_q+1, and its ratio R as a line [Mitsunaga99 eq. 5].

    Samples that are NaN, for one of the two frames clips them, are left out.
    """
    M, fM, R = (np.asarray(one, np.float64) for one in (M, fM, R))
    if M.shape != fM.shape or M.ndim != 2 or R.shape != (M.shape[1] - 1,):
        got = f"{M.shape}, {fM.shape} and {R.shape}"
        raise InputError(f"expected M and f(M) (N, P) and R (P - 1,), got {got}")
    ax = axes()
    for q, (colour, marker) in zip(range(len(R)), SAMPLES, strict=False):
        held = fM[:, q + 1] > 0
        ax.plot(M[held, q + 1], fM[held, q] / fM[held, q + 1], marker, color=colour, markersize=3)
        ax.plot(
            [0, 1],
            [R[q], R[q]],
            color=colour,
            linewidth=1.4,
            label=f"R{chr(0x2081 + q)} = {R[q]:.3f}",
        )
    ax.set(
        xlabel="brightness of the longer exposure, M", ylabel="quotient of exposures, f(M) / f(M)"
    )
    ax.set(xlim=(0, 1), ylim=(0, 1))
    size = min(10, 42 / len(R))
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncols=len(R), fontsize=size, **NARROW)
    return ax
