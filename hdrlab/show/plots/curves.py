"""Plots of labeled curves, such as responses and their errors.

x        (K,), shared by all curves of a plot
curves   label -> (K,)
g        response       (256,), ln exposure of each pixel value;  truth, the camera's own
M        brightness     (N, P), 0 to 1: sample p in frame q, frames from short to long
f(M)     exposure       (N, P), 0 to 1
R        ratios         (P - 1,), exposure of a frame over that of the next longer one

Colors and line styles differ together, so that a reader who sees no colors can follow a curve.
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
    LINE_STYLES,
    NARROW_LEGEND,
    SAMPLE_STYLES,
    Ends,
    axes,
    fix_limits,
    logarithmic,
    with_legend,
)

SUBSCRIPT_ONE = 0x2081


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
    """Draw up to six curves over x, each with its label; the first is black, as the reference.

    `limits` fix the ends of y, so that a slider moves only the curves. On an `ax` that has curves,
    the colors continue after theirs.
    """
    x = np.asarray(x, np.float64)
    ax = ax or axes()
    present = len(ax.lines)
    count = present + len(curves)
    if count > len(LINE_STYLES):
        raise InputError(f"expected at most {len(LINE_STYLES)} curves in one plot, got {count}")
    styles = LINE_STYLES[present:]
    for (color, style), (label, y) in zip(styles, curves.items(), strict=False):
        if np.shape(y) != x.shape:
            raise InputError(f"expected {label} with the shape of x, {x.shape}, got {describe(y)}")
        ax.plot(x, y, linestyle=style, color=color, linewidth=1.8, label=label)
    ax.set(xlabel=across, ylabel=up)
    fix_limits(ax, None, limits)
    if scale == "log":
        logarithmic(ax, "y", _format_power)
    return with_legend(ax, legend)


def _format_power(x: float, _: object) -> str:
    """Return a power of ten with at most five letters, because more would overlap the axis label."""
    return f"{x:g}" if x >= 1e-3 else f"{x:.0e}"


def deviations(
    responses: Mapping[str, ArrayLike],
    truth: ArrayLike,
    *,
    limit: float = 0.5,
    span: Ends = None,
) -> Axes:
    """Draw the error of each response in stops over the true exposure, at pixel values 10 to 250.

    `limit` and `span` fix the ends of y and x, so that a slider moves only the curves.
    """
    true_stops = np.asarray(truth, np.float64)[RELIABLE_LEVELS] / np.log(2)
    ax = axes()
    ax.axhline(0, color="#808080", linewidth=1, zorder=1)
    for (color, style), (name, g) in zip(LINE_STYLES[1:], responses.items(), strict=False):
        error = np.asarray(g)[RELIABLE_LEVELS] / np.log(2) - true_stops
        ax.plot(true_stops, error, linestyle=style, color=color, linewidth=1.6, label=name)
    ax.set(
        xlabel="true exposure, stops from that of pixel value 128",
        ylabel="estimated − true, stops",
    )
    fix_limits(ax, span, (-limit, limit))
    return with_legend(ax, "upper left")


def bundle(x: ArrayLike, curves: ArrayLike, *, label: str, across: str, up: str) -> Axes:
    """Draw many thin curves (C, K) alike, as a background for a few curves with names."""
    ax = axes()
    paths = [np.column_stack([x, y]) for y in np.atleast_2d(curves)]
    ax.add_collection(
        LineCollection(paths, colors="#56B4E9", linewidths=0.5, alpha=0.7, label=label)
    )
    ax.autoscale_view()
    ax.set(xlabel=across, ylabel=up)
    return with_legend(ax, "upper left")


def quotients(M: ArrayLike, fM: ArrayLike, R: ArrayLike) -> Axes:
    """Draw f^-1(M_q) / f^-1(M_q+1) over M_q+1, and the ratio R_q as a line [Mitsunaga99 eq. 5].

    Samples that are NaN, because one of the two frames is clipped, are left out.
    """
    M = np.asarray(M, np.float64)
    fM = np.asarray(fM, np.float64)
    R = np.asarray(R, np.float64)
    if M.shape != fM.shape or M.ndim != 2 or R.shape != (M.shape[1] - 1,):
        got = f"{M.shape}, {fM.shape} and {R.shape}"
        raise InputError(f"expected M and f(M) (N, P) and R (P - 1,), got {got}")
    ax = axes()
    for q, (color, marker) in zip(range(len(R)), SAMPLE_STYLES, strict=False):
        is_positive = fM[:, q + 1] > 0
        quotient = fM[is_positive, q] / fM[is_positive, q + 1]
        ax.plot(M[is_positive, q + 1], quotient, marker, color=color, markersize=3)
        subscript = chr(SUBSCRIPT_ONE + q)
        label = f"R{subscript} = {R[q]:.3f}"
        ax.plot([0, 1], [R[q], R[q]], color=color, linewidth=1.4, label=label)
    ax.set(
        xlabel="brightness of the longer exposure, M",
        ylabel="quotient of exposures, f⁻¹(M) / f⁻¹(M)",
        xlim=(0, 1),
        ylim=(0, 1),
    )
    size = min(10, 42 / len(R))
    ax.legend(
        loc="lower center", bbox_to_anchor=(0.5, 1), ncols=len(R), fontsize=size, **NARROW_LEGEND
    )
    return ax
