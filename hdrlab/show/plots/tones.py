"""Tone mapping on its way -> matplotlib Axes and Figures: maps with a scale, trimmed histograms, bands.

v         a value per pixel     (H, W), or an index into `names`
b, f      histogram             edges of the bins (bins + 1,), ln luminance; pixels in each (bins,)
ceiling   most a bin may hold
L, Ld     luminance and display luminance

A map is drawn on a scale from yellow (much) to dark blue (little). Where the sign matters it is
orange above zero, violet below, and white at zero.
"""

from collections.abc import Mapping, Sequence
from typing import Any, cast

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from hdrlab.core.arrays import F64, ArrayLike, describe
from hdrlab.core.colour import encode_srgb
from hdrlab.errors import InputError
from hdrlab.show.plots import LINES, Ends, axes, figures, nearest, scaled_axes, with_legend

SIDE = 600  # pixels: a larger map is drawn by means of k x k pixels
SCALE = "viridis"
SIGNED = "PuOr_r"
BELOW = 0.68  # inches, for the scale
ABOVE = 0.3  # inches, for the name of a map


def maps(
    each: Mapping[str, ArrayLike],
    *,
    label: str,
    span: Ends = None,
    signed: bool = False,
    names: Sequence[object] = (),
) -> Figure:
    """Return one to three maps side by side, each under its name, above one scale.

    Parameters
    ----------
    each : name -> v (H, W), all of one shape; NaN is gray
    label : what the scale counts, with its unit
    span : ends of the scale; by default all but 1 % of the pixels fit, and for a signed map the
        middle is 0
    signed : whether zero is white, and the two signs differ in colour
    names : of the classes, where v is an index into them

    Examples
    --------
    >>> figure = maps({"slope": np.arange(6.0).reshape(2, 3)}, label="stops")
    >>> [ax.get_title() for ax in figure.axes if ax.get_title()]
    ['slope']
    """
    arrays = _arrays(each)
    norm, colours = _scale(arrays, span, signed, len(names))
    *shown, bar = _row(arrays, titled=any(each))
    for ax, name, v in zip(shown, each, arrays, strict=True):
        nearest.show(ax, v, colours=colours, norm=norm)
        ax.set_title(name, fontsize=11, pad=4)
    _draw_scale(bar, norm, colours, names)
    bar.set_xlabel(label)
    return cast(Figure, bar.figure)


def _draw_scale(bar: Axes, norm: Normalize, colours: Any, names: Sequence[object]) -> None:
    """Draw the colours of a scale, with its numbers or the names of its classes below."""
    low, high = (
        (-0.5, len(names) - 0.5) if names else map(float, norm.inverse(np.array([0.0, 1.0])))
    )
    each = np.arange(len(names)) if names else np.linspace(low, high, 256)
    nearest.show(bar, each[None], colours=colours, norm=norm, extent=(low, high, 0, 1)).set_zorder(
        1
    )
    if names:
        bar.set_xticks(range(len(names)), [str(name) for name in names])
    else:
        bar.xaxis.set_major_locator(MaxNLocator(7, steps=[1, 2, 5, 10]))


def trims(
    b: ArrayLike,
    whole: ArrayLike,
    f: ArrayLike,
    *,
    ceiling: float = np.inf,
    top: float | None = None,
) -> Axes:
    """Draw a histogram as it was, pale, what the trims left of it, and the ceiling of the last trim.

    `top` fixes the axis: bins that are taller go beyond it, as the first few mostly do.
    """
    b = np.asarray(b)
    whole = np.asarray(whole)
    f = np.asarray(f)
    ax = axes()
    if not (len(b) - 1 == len(whole) == len(f)):
        raise InputError(
            f"expected bins with one edge more, got {len(f)} and {len(whole)}, {len(b)} edges"
        )
    ax.stairs(whole, b, fill=True, color="#D0D0D0", label="as it was")
    ax.stairs(f, b, fill=True, color="#0072B2", label="what is left")
    if np.isfinite(ceiling):
        ax.axhline(
            ceiling, color="#D55E00", linestyle="--", linewidth=1.6, label="ceiling of this trim"
        )
    ax.set(xlabel="brightness b = ln L", ylabel="foveal pixels f(b)", xlim=(b[0], b[-1]))
    ax.set_ylim(0, top or 1.02 * whole.max(initial=1))
    return with_legend(ax, "upper right")


def bands(
    spreads: Mapping[str, tuple[ArrayLike, ArrayLike, ArrayLike]], *, middle: float | None = None
) -> Axes:
    """Draw what becomes of each luminance, from least to greatest: a curve is a line, an operator a band.

    Each of `spreads` is (L, least Ld, greatest Ld), as of `tonemap.curves.spread`; `middle` is the
    luminance at 0 stops, by default the median of the first L.
    """
    ax = axes()
    if not 0 < len(spreads) < len(LINES):
        raise InputError(
            f"expected 1 to {len(LINES) - 1} operators in one picture, got {len(spreads)}"
        )
    for (colour, style), (name, (L, least, greatest)) in zip(
        LINES[1:], spreads.items(), strict=False
    ):
        L = np.asarray(L, np.float64)
        lit = L > 0
        middle = middle or float(np.median(L[lit]))
        low, high = (255 * encode_srgb(np.asarray(Ld)[lit]) for Ld in (least, greatest))
        stops = np.log2(L[lit] / middle)
        ax.fill_between(stops, low, high, color=colour, alpha=0.3, linewidth=0)
        ax.plot(stops, low, linestyle=style, color=colour, linewidth=1.2, label=name)
        ax.plot(stops, high, linestyle=style, color=colour, linewidth=1.2)
    ax.set(xlabel="luminance, stops from the median", ylabel="level on the display", ylim=(-3, 258))
    return with_legend(ax, "upper left")


def _arrays(each: Mapping[str, ArrayLike]) -> list[F64]:
    arrays = [np.asarray(v, np.float64) for v in each.values()]
    if not 1 <= len(arrays) <= 3 or any(v.ndim != 2 or v.shape != arrays[0].shape for v in arrays):
        got = ", ".join(describe(v) for v in arrays) or "none"
        raise InputError(f"expected one to three maps (H, W) of one shape, got {got}")
    return [figures.fit(v, SIDE) for v in arrays]


def _scale(arrays: list[F64], span: Ends, signed: bool, classes: int) -> tuple[Normalize, Any]:
    colours = matplotlib.colormaps[SIGNED if signed else SCALE].with_extremes(
        bad=figures.MISSING_COLOR
    )
    if classes:
        return BoundaryNorm(np.arange(classes + 1) - 0.5, colours.N), colours
    if span is None:
        low, high = np.nanpercentile(np.stack(arrays), [0.5, 99.5])
        far = max(-low, high)
        span = (-far, far) if signed else (low, high)
    low, high = span
    return Normalize(low, high if high > low else low + 1), colours


def _row(arrays: list[F64], *, titled: bool) -> list[Axes]:
    """Return Axes for maps, and for their scale; one map is 5.4 inches wide, several have less each."""
    count = len(arrays)
    (h, w) = arrays[0].shape
    width = 5.4 if count == 1 else 3.4 * count
    across = (width - 0.1 * (count + 1)) / count
    tall = across * h / w
    above = ABOVE if titled else 0.08
    height = above + tall + BELOW
    lefts = (0.1 + k * (across + 0.1) for k in range(count))
    places = [(left / width, BELOW / height, across / width, tall / height) for left in lefts]
    return scaled_axes(width, height, places, (0.08, 0.47 / height, 0.84, 0.14 / height))
