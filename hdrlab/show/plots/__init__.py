"""Plots of arrays on matplotlib Axes, with units, in colors that color-blind readers can distinguish.

g    response        (256,) or (256, 3), ln exposure of each pixel level
Z    pixel levels    (N, P): sample i in frame j
lE   ln irradiance   (N,)
B    ln exposure times (P,)

Every function draws on a new figure, or on `ax` if it takes one, and returns the Axes. No function
shows or writes a figure.
"""

from collections.abc import Sequence
from itertools import chain
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hdrlab.core.arrays import ArrayLike, describe, to_256
from hdrlab.core.bracket import Bracket
from hdrlab.core.exposure_text import exposures as exposures, seconds as seconds
from hdrlab.errors import InputError
from hdrlab.show.plots import reuse

# Left, bottom, width and height, as fractions of a figure.
Place = tuple[float, float, float, float]
# The fixed ends of an axis, or None.
Ends = tuple[float, float] | None
# A line style of matplotlib: its name, or an offset and the lengths of dashes and gaps.
Dashes = str | tuple[int, tuple[float, ...]]

# Okabe and Ito's colors. Line styles and markers differ too, so that plots can be read in gray.
COLORS = ("#D55E00", "#0072B2", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
BLACK = "#1A1A1A"
GRID_COLOR = "#D9D9D9"
# Name, color and line style of each channel.
CHANNELS = (("red", "#D55E00", "-"), ("green", "#009E73", "--"), ("blue", "#0072B2", ":"))
GRAY_CHANNEL = (("", BLACK, "-"),)
# Color and marker of each of a few samples.
SAMPLE_STYLES = tuple(zip(COLORS, "os^Dv*", strict=True))
# Color and line style of each of a few curves.
LINE_DASHES: tuple[Dashes, ...] = ("-", "-", "--", "-.", ":", (0, (8, 2)))
LINE_STYLES = tuple(zip((BLACK, *COLORS[:5]), LINE_DASHES, strict=True))
# Options of a narrow legend.
NARROW_LEGEND: dict[str, Any] = {
    "handlelength": 1.2,
    "columnspacing": 1.0,
    "borderaxespad": 0.2,
    "frameon": False,
}


def axes(width: float = 5.4, height: float = 3.6) -> Axes:
    """Return the Axes of a new figure (inches), at the same place in every figure of a size."""

    def make() -> list[Axes]:
        figure = Figure(figsize=(width, height), dpi=100)
        left = 0.75
        bottom = 0.6
        right = 0.2
        top = 0.35
        place = (
            left / width,
            bottom / height,
            1 - (left + right) / width,
            1 - (bottom + top) / height,
        )
        ax = figure.add_axes(place)
        ax.grid(color=GRID_COLOR, linewidth=0.6)
        ax.set_axisbelow(True)
        return [ax]

    return reuse.take((width, height), make)[0]


def picture_axes(width: float, height: float, place: Place) -> Axes:
    """Return bare Axes for an image, at a place in a figure of this size (inches)."""

    def make() -> list[Axes]:
        figure = Figure(figsize=(width, height), dpi=100)
        return [bare(figure.add_axes(place))]

    return reuse.take((width, height, *place), make)[0]


def scaled_axes(width: float, height: float, places: Sequence[Place], bar: Place) -> list[Axes]:
    """Return bare Axes for several maps, and Axes for their color scale, which has no y axis."""

    def make() -> list[Axes]:
        figure = Figure(figsize=(width, height), dpi=100)
        maps = [bare(figure.add_axes(place)) for place in places]
        scale = figure.add_axes(bar)
        scale.set_axisbelow(True)
        scale.yaxis.set_visible(False)
        return [*maps, scale]

    return reuse.take((width, height, *chain(*places, bar)), make)


def bare(ax: Axes) -> Axes:
    """Remove the frame and the ticks from Axes that show an image, and return the Axes."""
    ax.set_axis_off()
    # Without visible axes, matplotlib places titles faster.
    ax.xaxis.set_visible(False)
    ax.yaxis.set_visible(False)
    return ax


def fix_limits(ax: Axes, span: Ends = None, limits: Ends = None) -> None:
    """Fix the ends of x (`span`) and of y (`limits`), so that a slider does not move the ticks."""
    if span is not None:
        ax.set_xlim(span)
    if limits is not None:
        ax.set_ylim(limits)


def logarithmic(ax: Axes, which: str = "x", numbers: Any = "{x:g}") -> Axes:
    """Give an axis a logarithmic scale, and return the Axes."""
    ax.set(**{f"{which}scale": "log"})
    # Minor ticks and powers in mathematical type would take longer to draw than all the rest.
    ax.minorticks_off()
    getattr(ax, f"{which}axis").set_major_formatter(numbers)
    return ax


def with_legend(ax: Axes, place: Any) -> Axes:
    """Add a legend that is slightly transparent, and return the Axes."""
    ax.legend(loc=place, framealpha=0.9)
    return ax


def response(
    g: ArrayLike,
    *,
    label: str = "",
    span: Ends = None,
    levels: ArrayLike | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw response curves, pixel value over ln exposure, with a line per channel.

    With `levels` (C, 2), each channel's curve is drawn from the first to the last of its two pixel
    values only, such as those of `diagnostics.consistency.find_measured_levels`.
    """
    curves = np.asarray(g, dtype=np.float64)
    if curves.ndim not in (1, 2) or (curves.ndim == 2 and curves.shape[1] != 3):
        raise InputError(f"expected a response (n,) or (n, 3), got {describe(curves)}")
    ax = _exposure_axes(ax or axes(), span, len(curves))
    channels = CHANNELS if curves.ndim == 2 else GRAY_CHANNEL
    columns = curves.reshape(len(curves), -1).T
    pixel_values = np.arange(len(curves))
    ends = np.full((len(columns), 2), [0, len(curves) - 1])
    if levels is not None:
        ends[:] = levels
    for (name, color, style), curve, (low, high) in zip(channels, columns, ends, strict=True):
        drawn = slice(low, high + 1)
        ax.plot(
            curve[drawn],
            pixel_values[drawn],
            style,
            color=color,
            linewidth=1.8,
            label=f"{label} {name}".strip(),
        )
    if label or curves.ndim == 2:
        with_legend(ax, "upper left")
    return ax


def samples(
    Z: ArrayLike, lE: ArrayLike, B: ArrayLike, *, g: ArrayLike | None = None, span: Ends = None
) -> Axes:
    """Draw each sample i as its points (lE_i + B_j, Z_ij), which with the right lE form one curve, g.

    Up to six samples have a color and a marker each; more are drawn alike. `span` fixes the
    exposure axis.
    """
    Z = np.asarray(Z)
    lE = np.asarray(lE, dtype=np.float64)
    B = np.asarray(B, dtype=np.float64)
    if Z.ndim != 2 or Z.shape != lE.shape + B.shape:
        raise InputError(
            f"expected Z (N, P), lE (N,) and B (P,), got {Z.shape}, {lE.shape} and {B.shape}"
        )
    ax = _exposure_axes(axes(), span, 256)
    x = lE[:, None] + B
    if g is not None:
        levels = np.arange(len(np.asarray(g)))
        above_the_points = 3
        ax.plot(g, levels, color=BLACK, linewidth=1.5, zorder=above_the_points, label="g")
    if len(Z) <= len(SAMPLE_STYLES):
        for i, (color, marker) in enumerate(SAMPLE_STYLES[: len(Z)]):
            label = f"pixel {i + 1}"
            ax.plot(x[i], Z[i], "-", marker=marker, color=color, linewidth=0.8, label=label)
    else:
        ax.plot(x.ravel(), Z.ravel(), ".", color="#56B4E9", markersize=5, label=f"{len(Z)} pixels")
    return with_legend(ax, "upper left")


def system(A: ArrayLike) -> Axes:
    """Draw a dot for each element of a matrix that is not zero, with the equations as rows."""
    A = np.asarray(A)
    ax = axes(4.2, 5.4)
    rows, columns = np.nonzero(A)
    ax.plot(columns, rows, ".", color=BLACK, markersize=2)
    ax.set(xlabel="unknown (column of A)", ylabel="equation (row of A)")
    ax.set(xlim=(-3, A.shape[1] + 2), ylim=(A.shape[0] + 2, -3))
    return ax


def thumbnails(bracket: Bracket, *, offsets: ArrayLike | None = None, columns: int = 3) -> Figure:
    """Draw the photos in rows, each with its exposure and, if given, its offset (dy, dx)."""
    count = len(bracket.images)
    h, w = bracket.images.shape[1:3]
    rows = -(-count // columns)
    width = 1.75
    title = 0.25 if offsets is None else 0.4
    height = width * h / w + title
    figure = Figure(figsize=(columns * width, rows * height), dpi=100)
    for j, (image, exposure) in enumerate(zip(bracket.images, exposures(bracket), strict=True)):
        row, column = divmod(j, columns)
        place = (
            column / columns,
            1 - (row + 1) / rows,
            0.97 / columns,
            (1 - title / height) / rows,
        )
        ax = figure.add_axes(place)
        step = max(1, w // 350)
        ax.imshow(to_256(image[::step, ::step]), cmap="gray", vmin=0, vmax=255)
        title_text = exposure
        if offsets is not None:
            dy, dx = np.asarray(offsets)[j]
            title_text += f"\ndy {dy:+d}, dx {dx:+d} px"
        ax.set_title(title_text, fontsize=11, pad=3)
        bare(ax)
    return figure


def _exposure_axes(ax: Axes, span: Ends, n: int) -> Axes:
    ax.set(xlabel="ln exposure, ln(E t)", ylabel="pixel level Z", ylim=(-0.02 * n, 1.02 * n))
    fix_limits(ax, span)
    return ax
