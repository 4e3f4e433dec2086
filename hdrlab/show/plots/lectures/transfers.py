"""Plots that compare two photos: comparagram, histogram ranks, ladder of levels, exposure ratio.

J    comparagram         (256, 256), number of pixels with value m in frame A and z in frame B
T    transfer            (256,), the value in B of pixels with value m in A; NaN where not known
h    histograms          (256,) of A and of B
s    series              (K,) pixel values, each R times the exposure of the one before
x, y equations           y = k x, and which of them are used
"""

from collections.abc import Mapping
from typing import Literal

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.patches import Patch

from hdrlab.core.arrays import ArrayLike, describe
from hdrlab.errors import InputError
from hdrlab.show.plots import (
    BLACK,
    LINE_STYLES,
    SAMPLE_STYLES,
    Ends,
    axes,
    fix_limits,
    with_legend,
)

NO_PIXELS_COLOR = "#E6E6E6"


def comparagram(
    J: ArrayLike,
    *,
    T: ArrayLike | None = None,
    label: str = "pixels",
    across: str = "pixel value m in frame A",
    up: str = "pixel value z in frame B",
) -> Axes:
    """Draw the number of pixels with value m in A and z in B on a logarithmic color scale, with T.

    The scale ends at the largest count apart from clipped values, whose counts are far larger.
    """
    J = np.asarray(J, np.float64)
    if J.ndim != 2 or J.shape[0] != J.shape[1] or len(J) < 3 or not np.any(J > 0):
        raise InputError(f"expected a comparagram (n, n) with counts in it, got {describe(J)}")
    largest = J[1:-1, 1:-1].max() or J.max()
    scale = LogNorm(max(largest / 1000, J[J > 0].min()), largest)
    ax = axes(5.4, 4.3)
    ax.set_facecolor(NO_PIXELS_COLOR)
    counts = np.where(J > 0, J, np.nan).T
    above_the_grid = 1
    image = ax.imshow(
        counts, norm=scale, origin="lower", interpolation="nearest", zorder=above_the_grid
    )
    shown_counts = [count for count in 10.0 ** np.arange(15) if scale.vmin <= count <= scale.vmax]
    swatches: list[Artist] = [
        Patch(facecolor=image.cmap(scale(count)), label=f"{count:,.0f}") for count in shown_counts
    ]
    if T is not None:
        m = np.arange(len(J))
        ax.plot(m, T, color="#FFFFFF", linewidth=3.2)
        swatches += ax.plot(m, T, color="#D55E00", linewidth=1.6, label="T, from the histograms")
    if swatches:
        is_brighter = np.triu(J).sum() >= np.tril(J).sum()
        loc: Literal["lower right", "upper left"] = "lower right" if is_brighter else "upper left"
        ax.legend(handles=swatches, title=label, loc=loc, framealpha=0.9)
    ax.set(xlabel=across, ylabel=up, aspect="auto")
    return ax


def ranks(h_A: ArrayLike, h_B: ArrayLike, m: int, T: ArrayLike) -> Axes:
    """Draw both cumulative histograms, and how pixel value m of A maps to T(m) of B at equal rank."""
    H_A = np.cumsum(h_A) / np.sum(h_A)
    H_B = np.cumsum(h_B) / np.sum(h_B)
    values = np.arange(len(H_A))
    percent = 100 * (H_A[m] - np.diff(H_A, prepend=0)[m] / 2)
    ax = axes()
    for (color, style), H, name in zip(
        LINE_STYLES[1:], (H_A, H_B), ("frame A", "frame B"), strict=False
    ):
        ax.plot(values, 100 * H, linestyle=style, color=color, drawstyle="steps-mid", label=name)
    z = float(np.asarray(T)[m])
    if np.isfinite(z):
        label = f"{m} in A is {z:.1f} in B"
        x = [m, m, z, z]
        y = [0, percent, percent, 0]
    else:
        label = f"{m} in A is clipped in B"
        x = [m, m]
        y = [0, percent]
    ax.plot(x, y, color=BLACK, linewidth=1.2, marker="o", markersize=4, label=label)
    ax.set(
        xlabel="pixel value",
        ylabel="pixels at this value or below, %",
        xlim=(0, 255),
        ylim=(0, 102),
    )
    return with_legend(ax, "upper left")


def staircase(T: ArrayLike, s: ArrayLike) -> Axes:
    """Draw the series s as a staircase between T, bright frame to dark, and the diagonal."""
    T = np.asarray(T, np.float64)
    s = np.asarray(s, np.float64)
    ax = axes(4.6, 4.2)
    n = len(T)
    ax.plot([0, n - 1], [0, n - 1], color="#808080", linewidth=1, label="the same value")
    ax.plot(np.arange(n), T, color="#D55E00", linewidth=1.8, label="T, bright to dark")
    x = np.repeat(s, 2)[:-1]
    y = np.repeat(s, 2)[1:]
    ax.plot(
        x, y, color="#0072B2", linewidth=1, marker="s", markersize=3.5, label=f"{len(s)} values"
    )
    ax.set(
        xlabel="pixel value in the bright frame",
        ylabel="pixel value in the dark frame",
        xlim=(0, n),
        ylim=(0, n),
    )
    return with_legend(ax, "upper left")


def ladders(series: Mapping[str, tuple[ArrayLike, float]]) -> Axes:
    """Draw series (s, R) with a logarithmic y axis over stops, each with its best straight line."""
    ax = axes()
    for (color, style), (_, marker), (name, (s, R)) in zip(
        LINE_STYLES[1:], SAMPLE_STYLES, series.items(), strict=False
    ):
        values = np.asarray(s, np.float64)
        stops = np.arange(len(values)) * np.log2(R)
        slope, intercept = np.polyfit(stops, np.log2(values), 1)
        label = f"{name}: slope {slope:.2f}"
        line = 2 ** (intercept + slope * stops)
        ax.plot(stops, values, marker, color=color, markersize=5, label=label)
        ax.plot(stops, line, linestyle=style, color=color, linewidth=1.2)
    ax.set(
        xlabel="exposure, stops below that of the first value",
        ylabel="pixel value",
        yscale="log",
        ylim=(10, 400),
    )
    ax.set_yticks([10, 20, 50, 100, 200], ["10", "20", "50", "100", "200"])
    ax.minorticks_off()
    return with_legend(ax, "lower right")


def equations(
    x: ArrayLike,
    y: ArrayLike,
    used: ArrayLike,
    k: float,
    *,
    against: float = 0.0,
    span: Ends = None,
    limits: Ends = None,
) -> Axes:
    """Draw equations y = k x minus `against` times x, removed ones in gray, and the line of k.

    `span` and `limits` fix the axes, so that a slider moves only the equations.
    """
    x = np.asarray(x)
    y = np.asarray(y)
    used = np.asarray(used, bool)
    ax = axes()
    difference = y - against * x
    removed = ~used
    ax.plot(
        x[removed],
        difference[removed],
        "x",
        color="#999999",
        markersize=4,
        label=f"{removed.sum()} removed",
    )
    ax.plot(
        x[used],
        difference[used],
        ".",
        color="#0072B2",
        markersize=5,
        label=f"{used.sum()} in use",
    )
    ends = np.array([0, x.max(initial=1)])
    ax.plot(ends, (k - against) * ends, color="#D55E00", linewidth=1.8, label=f"k = {k:.4f}")
    subtracted = f" − {against:g} × value in A" if against else ""
    ax.set(xlabel="pixel value in the darker frame A", ylabel=f"pixel value in B{subtracted}")
    fix_limits(ax, span or (0, ends[1] * 1.02), limits)
    return with_legend(ax, "upper left")
