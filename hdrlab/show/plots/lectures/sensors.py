"""What a sensor holds and loses -> pictures and matplotlib Axes, in the look of `show.plots`.

L      luminance   (K,) or (H, W), cd/m^2
held   what one exposure makes of it: `capture.ranges.ExposedLevels`
full, noise        (H, W) bool, pixels that are full, and those that noise has swallowed
found  a photon transfer curve: `capture.photon_transfer.Transfer`

What is full is orange, what is lost in noise blue, here as in the benches; hatching tells them
apart as well.
"""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.patheffects import withStroke

from hdrlab.capture import photon_transfer, planning, ranges
from hdrlab.core.arrays import ArrayLike, NDArray, as_picture, describe
from hdrlab.errors import InputError
from hdrlab.show.plots import (
    Ends,
    axes,
    fix_limits,
    logarithmic,
    nearest,
    picture_axes,
    with_legend,
)

FULL = "#D55E00"
NOISE = "#0072B2"
KEPT = "#B8B8B8"
ORANGE = np.array([213, 94, 0], np.uint8)
BLUE = np.array([0, 114, 178], np.uint8)
KINDS = (("lost in noise", NOISE, "///"), ("held", KEPT, ""), ("full", FULL, "..."))
BINS = 60


def mark_lost(picture: ArrayLike, full: ArrayLike, noise: ArrayLike) -> NDArray[np.uint8]:
    """Return a picture (H, W[, 3]) uint8 in which full pixels are orange and those lost in noise blue."""
    shown = as_picture(picture)
    shown = np.repeat(shown[..., None], 3, axis=-1) if shown.ndim == 2 else shown.copy()
    for mask, colour in ((full, ORANGE), (noise, BLUE)):
        if np.shape(mask) != shown.shape[:2]:
            raise InputError(f"expected a mask of shape {shown.shape[:2]}, got {describe(mask)}")
        shown[np.asarray(mask, bool)] = colour
    return shown


def window(L: ArrayLike, held: ranges.ExposedLevels, *, limits: Ends = None) -> Axes:
    """Draw how the pixels of a scene spread over luminance, and which of them one exposure holds."""
    L = np.asarray(L, np.float64).ravel()
    ax = axes()
    if L.shape != np.shape(held.full) or not np.all(L > 0):
        raise InputError(f"expected positive luminances {np.shape(held.full)}, got {describe(L)}")
    low, high = limits or (float(L.min()), float(L.max()) * 1.0001)
    edges = np.geomspace(low, high, BINS + 1)
    below = np.zeros(BINS + 1)
    lost = (held.noise & ~held.full, ~held.noise & ~held.full, held.full)
    for (label, colour, hatch), mask in zip(KINDS, lost, strict=True):
        above = below + 100 * np.append(np.histogram(L[mask], edges)[0], 0) / L.size
        style: dict[str, Any] = dict(facecolor=colour, hatch=hatch, edgecolor="white", linewidth=0)
        ax.fill_between(
            edges, below, above, step="post", label=f"{label}: {mask.mean():.0%}", **style
        )
        below = above
    ax.set(xlabel="luminance, cd/m²", ylabel="pixels, %", xlim=(low, high), ylim=(0, None))
    return logarithmic(with_legend(ax, "upper right"))


def staircase(L: ArrayLike, held: ranges.ExposedLevels) -> Axes:
    """Draw the converter's level over luminance, and where nothing is told [Battiato08 fig. 1.10 to 1.12]."""
    L = np.asarray(L, np.float64)
    ax = axes()
    if L.shape != np.shape(held.Z) or L.ndim != 1:
        raise InputError(f"expected luminances {np.shape(held.Z)}, got {describe(L)}")
    ax.step(L, held.Z, where="mid", color="#1A1A1A", linewidth=1.8)
    for (label, colour, hatch), mask in ((KINDS[0], held.noise), (KINDS[2], held.full)):
        if mask.any():
            span: dict[str, Any] = dict(
                color=colour, alpha=0.35, hatch=hatch, linewidth=0, label=label
            )
            ax.axvspan(L[mask][0], L[mask][-1], **span)
    ax.set(xlabel="luminance, any unit", ylabel="level of the converter", xlim=(L[0], L[-1]))
    if held.noise.any() or held.full.any():
        with_legend(ax, "upper left")
    return logarithmic(ax)


def transfer(found: photon_transfer.Transfer, *, span: Ends = None, limits: Ends = None) -> Axes:
    """Draw a photon transfer curve: variance over signal, the line through it, and what was left out.

    `span` and `limits` fix the axes, so that a slider turns the line and nothing else.
    """
    S = np.maximum(found.S, 0)
    V = found.V
    used = found.used
    ax = axes()
    ax.plot(S[used], V[used], "o", color="#D55E00", label="pairs that are used")
    ax.plot(S[~used], V[~used], "x", color="#0072B2", label="too close to a full well")
    line = np.array([0, S.max()])
    ax.plot(
        line, V[0] + line / found.gain, "-", color="#1A1A1A", label=f"slope 1 / {found.gain:.3g}"
    )
    ax.set(xlabel="signal S, levels above black", ylabel="variance V, levels squared")
    fix_limits(ax, span, limits)
    return with_legend(ax, "upper left")


def coverage(plan: planning.Plan, low: float, high: float) -> Axes:
    """Draw which luminances each photograph of a plan holds, the shortest on top, and those of the scene."""
    ax = axes()
    ax.axvspan(low, high, color=KEPT, alpha=0.45, label="the scene", linewidth=0)
    for row, (name, (dark, bright)) in enumerate(zip(plan.names, plan.holds, strict=True)):
        ax.plot([dark, bright], [row, row], color=NOISE, linewidth=7, solid_capstyle="butt")
        ax.annotate(
            f"{name} s", (np.sqrt(dark * bright), row - 0.22), ha="center", va="bottom", fontsize=9
        )
    count = len(plan.names)
    ax.set(
        xlabel="luminance, cd/m²",
        ylabel="photograph",
        yticks=range(count),
        ylim=(count - 0.5, -0.8),
    )
    ax.set(xlim=(low / 200, high * 200), yticklabels=range(1, count + 1))
    return logarithmic(with_legend(ax, "lower right"))


def bars(counts: ArrayLike, *, across: str, up: str, limit: float | None = None) -> Axes:
    """Draw a number of each of a few kinds, counted from 1, on a logarithmic scale."""
    counts = np.asarray(counts)
    ax = axes()
    x = np.arange(1, len(counts) + 1)
    ax.bar(x, counts, color="#0072B2", bottom=0.7)
    for at, count in zip(x, counts, strict=True):
        ax.annotate(f"{count:g}", (at, 0.7 + count), ha="center", va="bottom", fontsize=9)
    ax.set(xlabel=across, ylabel=up, ylim=(0.7, limit or 3 * counts.max()), xticks=x)
    return logarithmic(ax, "y")


def draw_titled(
    picture: ArrayLike, text: str, *, ring: ArrayLike | None = None, width: float = 5.4
) -> Axes:
    """Draw a picture (H, W[, 3]) uint8 under lines of text, with the edge of a region if one is given."""
    shown = as_picture(picture)
    high = width * shown.shape[0] / shown.shape[1]
    lines = 0.25 * (text.count("\n") + 1) + 0.12
    ax = picture_axes(width, high + lines, (0, 0, 1, high / (high + lines)))
    nearest.show(ax, shown, colours="gray", norm=Normalize(0, 255))
    if ring is not None and 0 < np.asarray(ring, float).mean() < 1:
        edge = ax.contour(np.asarray(ring, float), [0.5], colors="white", linewidths=1.2)
        edge.set_path_effects([withStroke(linewidth=3, foreground="black")])
    ax.text(
        0.01,
        1 - 0.06 / (high + lines),
        text,
        va="top",
        fontsize=11.5,
        transform=ax.figure.transFigure,
    )
    return ax
