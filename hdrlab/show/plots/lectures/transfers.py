"""Two photographs compared -> matplotlib Axes: comparagram, ranks, ladder, ratio.

J    comparagram         (256, 256), how many pixels have level m in frame A and z in frame B
T    transfer            (256,), the level in B of what has level m in A; NaN where that is not known
h    histograms          (256,) of A and of B
s    series              (K,) levels, each R times the exposure of the one before
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
from hdrlab.show.plots import LINES, SAMPLES, Ends, axes, fix_limits, with_legend


def comparagram(
    J: ArrayLike,
    *,
    T: ArrayLike | None = None,
    label: str = "pixels",
    across: str = "level m in frame A",
    up: str = "level z in frame B",
) -> Axes:
    """Draw how many pixels have level m in A and z in B, in colours on a logarithmic scale, with T on it.

    The scale ends at the largest count between the clipped levels, which hold far more than all
    others.
    """
    J = np.asarray(J, np.float64)
    if J.ndim != 2 or J.shape[0] != J.shape[1] or len(J) < 3 or not np.any(J > 0):
        raise InputError(f"expected a comparagram (n, n) with counts in it, got {describe(J)}")
    most = J[1:-1, 1:-1].max() or J.max()
    scale = LogNorm(max(most / 1000, J[J > 0].min()), most)
    ax = axes(5.4, 4.3)
    ax.set_facecolor("#E6E6E6")  # no pixel has these two levels
    counted = np.where(J > 0, J, np.nan).T
    # upon the grid
    shown = ax.imshow(counted, norm=scale, origin="lower", interpolation="nearest", zorder=1)
    counts = [count for count in 10.0 ** np.arange(15) if scale.vmin <= count <= scale.vmax]
    named = {f"{count:,.0f}": shown.cmap(scale(count)) for count in counts}
    swatches: list[Artist] = [Patch(facecolor=colour, label=name) for name, colour in named.items()]
    if T is not None:
        m = np.arange(len(J))
        ax.plot(m, T, color="#FFFFFF", linewidth=3.2)
        swatches += ax.plot(m, T, color="#D55E00", linewidth=1.6, label="T, from the histograms")
    if swatches:
        brighter = np.triu(J).sum() >= np.tril(J).sum()
        loc: Literal["lower right", "upper left"] = "lower right" if brighter else "upper left"
        ax.legend(handles=swatches, title=label, loc=loc, framealpha=0.9)
    ax.set(xlabel=across, ylabel=up, aspect="auto")
    return ax


def ranks(h_A: ArrayLike, h_B: ArrayLike, m: int, T: ArrayLike) -> Axes:
    """Draw both cumulated histograms, and the way from level m of A at its rank across to T(m) of B."""
    H_A, H_B = (np.cumsum(h) / np.sum(h) for h in (h_A, h_B))
    level = np.arange(len(H_A))
    rank = H_A[m] - np.diff(H_A, prepend=0)[m] / 2
    ax = axes()
    for (colour, style), H, name in zip(
        LINES[1:], (H_A, H_B), ("frame A", "frame B"), strict=False
    ):
        ax.plot(level, 100 * H, linestyle=style, color=colour, drawstyle="steps-mid", label=name)
    z = float(np.asarray(T)[m])
    label = (
        f"level {m} of A is level {z:.1f} of B"
        if np.isfinite(z)
        else f"level {m} of A is clipped in B"
    )
    way = (
        ([m, m, z, z], np.array([0, rank, rank, 0]) * 100)
        if np.isfinite(z)
        else ([m, m], [0, 100 * rank])
    )
    ax.plot(*way, color="#1A1A1A", linewidth=1.2, marker="o", markersize=4, label=label)
    ax.set(
        xlabel="pixel level",
        ylabel="pixels at this level or below, %",
        xlim=(0, 255),
        ylim=(0, 102),
    )
    return with_legend(ax, "upper left")


def staircase(T: ArrayLike, s: ArrayLike) -> Axes:
    """Draw the series s going down between T, bright frame to dark, and the line of equal levels."""
    T = np.asarray(T, np.float64)
    s = np.asarray(s, np.float64)
    ax = axes(4.6, 4.2)
    n = len(T)
    ax.plot([0, n - 1], [0, n - 1], color="#808080", linewidth=1, label="the same level")
    ax.plot(np.arange(n), T, color="#D55E00", linewidth=1.8, label="T, bright to dark")
    x = np.repeat(s, 2)[:-1]
    y = np.repeat(s, 2)[1:]
    ax.plot(
        x, y, color="#0072B2", linewidth=1, marker="s", markersize=3.5, label=f"{len(s)} levels"
    )
    ax.set(
        xlabel="level in the bright frame",
        ylabel="level in the dark frame",
        xlim=(0, n),
        ylim=(0, n),
    )
    return with_legend(ax, "upper left")


def ladders(found: Mapping[str, tuple[ArrayLike, float]]) -> Axes:
    """Draw series (s, R) on logarithmic paper, level over stops, each with its best straight line."""
    ax = axes()
    for (colour, style), (_, marker), (name, (s, R)) in zip(
        LINES[1:], SAMPLES, found.items(), strict=False
    ):
        levels = np.asarray(s, np.float64)
        stops = np.arange(len(levels)) * np.log2(R)
        slope, at = np.polyfit(stops, np.log2(levels), 1)
        ax.plot(
            stops, levels, marker, color=colour, markersize=5, label=f"{name}: slope {slope:.2f}"
        )
        ax.plot(stops, 2 ** (at + slope * stops), linestyle=style, color=colour, linewidth=1.2)
    ax.set(
        xlabel="exposure, stops below the first level's",
        ylabel="level",
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
    """Draw equations y = k x, less `against` times x, the removed ones pale, and the line of k.

    `span` and `limits` fix the axes, so that a slider moves the equations and nothing else.
    """
    x = np.asarray(x)
    y = np.asarray(y)
    used = np.asarray(used, bool)
    ax = axes()
    off = y - against * x
    out = ~used
    ax.plot(x[out], off[out], "x", color="#999999", markersize=4, label=f"{out.sum()} removed")
    ax.plot(x[used], off[used], ".", color="#0072B2", markersize=5, label=f"{used.sum()} in use")
    ends = np.array([0, x.max(initial=1)])
    ax.plot(ends, (k - against) * ends, color="#D55E00", linewidth=1.8, label=f"k = {k:.4f}")
    subtracted = f" − {against:g} × level in A" if against else ""
    ax.set(xlabel="level in the darker frame A", ylabel=f"level in B{subtracted}")
    fix_limits(ax, span or (0, ends[1] * 1.02), limits)
    return with_legend(ax, "upper left")
