"""Arrays -> matplotlib Axes, with units on every axis and colours that colour-blind readers tell apart.

g    response        (256,) or (256, 3), ln exposure of each pixel level
Z    pixel levels    (N, P): sample i in frame j
lE   ln irradiance   (N,)
B    ln exposure times (P,)

Every function draws on a new figure of its own, or on `ax` where it takes one, and returns the
Axes; nothing is shown or written here.
"""

from collections.abc import Sequence
from itertools import chain
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hdrlab.core.arrays import ArrayLike, describe, to_256
from hdrlab.core.bracket import Bracket
from hdrlab.errors import InputError
from hdrlab.show.plots import reuse

Place = tuple[float, float, float, float]  # left, bottom, width, height, in parts of a figure
Ends = tuple[float, float] | None  # of an axis, where they are fixed

# Okabe and Ito's colours. Line styles and markers differ too, so the channels also part in gray.
CHANNELS = (("red", "#D55E00", "-"), ("green", "#009E73", "--"), ("blue", "#0072B2", ":"))
GRAY = (("", "#1A1A1A", "-"),)
COLOURS = ("#D55E00", "#0072B2", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
SAMPLES = tuple(zip(COLOURS, "os^Dv*", strict=True))
# ... and of curves: colours and line styles differ together
Dashes = str | tuple[int, tuple[float, ...]]
STYLES: tuple[Dashes, ...] = ("-", "-", "--", "-.", ":", (0, (8, 2)))
LINES = tuple(zip(("#1A1A1A", *COLOURS[:5]), STYLES, strict=True))
NARROW: dict[str, Any] = {
    "handlelength": 1.2,
    "columnspacing": 1.0,
    "borderaxespad": 0.2,
    "frameon": False,
}


def axes(width: float = 5.4, height: float = 3.6) -> Axes:
    """Return the Axes of a new figure (inches), always in the same place: played steps do not jump."""

    def made() -> list[Axes]:
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
        ax.grid(color="#D9D9D9", linewidth=0.6)
        ax.set_axisbelow(True)
        return [ax]

    return reuse.take((width, height), made)[0]


def picture_axes(width: float, height: float, place: Place) -> Axes:
    """Return bare Axes for a picture, in a figure of this size (inches) at a place in parts of it."""
    size = (width, height)
    return reuse.take(
        (*size, *place), lambda: [bare(Figure(figsize=size, dpi=100).add_axes(place))]
    )[0]


def scaled_axes(width: float, height: float, places: Sequence[Place], bar: Place) -> list[Axes]:
    """Return bare Axes for each of some maps, and those of the scale that they share, without an axis up."""

    def made() -> list[Axes]:
        figure = Figure(figsize=(width, height), dpi=100)
        maps = [bare(figure.add_axes(place)) for place in places]
        scale = figure.add_axes(bar)
        scale.set_axisbelow(True)
        scale.yaxis.set_visible(False)
        return [*maps, scale]

    return reuse.take((width, height, *chain(*places, bar)), made)


def bare(ax: Axes) -> Axes:
    """Take the frame and the ticks from Axes that hold a picture; a title then need not look for ticks."""
    ax.set_axis_off()
    ax.xaxis.set_visible(False)
    ax.yaxis.set_visible(False)
    return ax


def fix_limits(ax: Axes, span: Ends = None, limits: Ends = None) -> None:
    """Fix the ends of x by `span` and those of y by `limits`, where given: a slider then moves no ticks."""
    if span is not None:
        ax.set_xlim(span)
    if limits is not None:
        ax.set_ylim(limits)


def logarithmic(ax: Axes, which: str = "x", numbers: Any = "{x:g}") -> Axes:
    """Return Axes of decades; minor ticks and powers in mathematical type take longer than all the rest."""
    ax.set(**{f"{which}scale": "log"})
    ax.minorticks_off()
    getattr(ax, f"{which}axis").set_major_formatter(numbers)
    return ax


def with_legend(ax: Axes, place: Any) -> Axes:
    """Return the Axes with a legend, through which a little of what it covers can be seen."""
    ax.legend(loc=place, framealpha=0.9)
    return ax


def seconds(time: float) -> str:
    """Return an exposure time as a camera shows it: '1/60 s', '2 s'.

    Examples
    --------
    >>> [seconds(t) for t in (1 / 60, 0.3, 2, 2.5)]
    ['1/60 s', '0.3 s', '2 s', '2.5 s']
    """
    if time >= 1 or abs(1 / time - round(1 / time)) > 0.02 / time:
        return f"{time:.3g} s"
    return f"1/{round(1 / time)} s"


def response(g: ArrayLike, *, label: str = "", span: Ends = None, ax: Axes | None = None) -> Axes:
    """Draw response curves, ln exposure across, pixel level up; one line per channel."""
    curves = np.asarray(g, dtype=np.float64)
    if curves.ndim not in (1, 2) or (curves.ndim == 2 and curves.shape[1] != 3):
        raise InputError(f"expected a response (n,) or (n, 3), got {describe(curves)}")
    ax = _exposure_axes(ax or axes(), span, len(curves))
    channels = CHANNELS if curves.ndim == 2 else GRAY
    levels = np.arange(len(curves))
    for (name, colour, style), curve in zip(
        channels, curves.reshape(len(curves), -1).T, strict=True
    ):
        ax.plot(curve, levels, style, color=colour, linewidth=1.8, label=f"{label} {name}".strip())
    return with_legend(ax, "upper left") if label or curves.ndim == 2 else ax


def samples(
    Z: ArrayLike, lE: ArrayLike, B: ArrayLike, *, g: ArrayLike | None = None, span: Ends = None
) -> Axes:
    """Draw each sample i as its points (lE_i + B_j, Z_ij): with the right lE they all lie on one curve, g.

    Up to six samples have a colour and a marker each; more are drawn alike. `span` fixes the
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
    if g is not None:  # above the points, which would hide it
        ax.plot(
            g, np.arange(len(np.asarray(g))), color="#1A1A1A", linewidth=1.5, zorder=3, label="g"
        )
    if len(Z) <= len(SAMPLES):
        for i, (colour, marker) in enumerate(SAMPLES[: len(Z)]):
            ax.plot(
                x[i], Z[i], "-", marker=marker, color=colour, linewidth=0.8, label=f"pixel {i + 1}"
            )
    else:
        ax.plot(x.ravel(), Z.ravel(), ".", color="#56B4E9", markersize=5, label=f"{len(Z)} pixels")
    return with_legend(ax, "upper left")


def system(A: ArrayLike) -> Axes:
    """Draw where a matrix is not zero: an equation across, an unknown down."""
    A = np.asarray(A)
    ax = axes(4.2, 5.4)
    ax.plot(*np.nonzero(A)[::-1], ".", color="#1A1A1A", markersize=2)
    ax.set(xlabel="unknown (column of A)", ylabel="equation (row of A)")
    ax.set(xlim=(-3, A.shape[1] + 2), ylim=(A.shape[0] + 2, -3))
    return ax


def thumbnails(bracket: Bracket, *, offsets: ArrayLike | None = None, columns: int = 3) -> Figure:
    """Draw the photographs in rows, each under its exposure time and, where given, its offset (dy, dx)."""
    count = len(bracket.images)
    (h, w) = bracket.images.shape[1:3]
    rows = -(-count // columns)
    width = 1.75
    title = 0.25 if offsets is None else 0.4
    height = width * h / w + title
    figure = Figure(figsize=(columns * width, rows * height), dpi=100)
    for j, (image, time) in enumerate(zip(bracket.images, bracket.times, strict=True)):
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
        moved = "" if offsets is None else "\ndy {:+d}, dx {:+d} px".format(*np.asarray(offsets)[j])
        ax.set_title(seconds(time) + moved, fontsize=11, pad=3)
        bare(ax)
    return figure


def _exposure_axes(ax: Axes, span: Ends, n: int) -> Axes:
    ax.set(xlabel="ln exposure, ln(E t)", ylabel="pixel level Z", ylim=(-0.02 * n, 1.02 * n))
    fix_limits(ax, span)
    return ax
