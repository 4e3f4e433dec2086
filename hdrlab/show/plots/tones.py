"""Plots of tone mapping: maps with a color scale, trimmed histograms, and bands of display values.

v         a value per pixel     (H, W), or an index into `names`
b, f      histogram             edges of the bins (bins + 1,), ln luminance; pixels in each (bins,)
ceiling   the largest count that a bin may have
L, Ld     luminance and display luminance

The color scale of a map runs from dark blue (low) to yellow (high). A signed map is orange above
zero, violet below, and white at zero.
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
from hdrlab.show.plots import LINE_STYLES, Ends, axes, figures, nearest, scaled_axes, with_legend

# A larger map is reduced to the means of k x k pixels.
MAX_MAP_SIDE = 600
COLOR_SCALE = "viridis"
SIGNED_COLOR_SCALE = "PuOr_r"
# Lengths are in inches.
SINGLE_MAP_WIDTH = 5.4
MAP_WIDTH = 3.4
GAP_WIDTH = 0.1
SCALE_HEIGHT = 0.68
TITLE_HEIGHT = 0.3
NO_TITLE_HEIGHT = 0.08


def maps(
    named_maps: Mapping[str, ArrayLike],
    *,
    label: str,
    span: Ends = None,
    signed: bool = False,
    names: Sequence[object] = (),
) -> Figure:
    """Draw one to three maps side by side, each with its name, and one color scale below.

    Parameters
    ----------
    named_maps : name -> v (H, W), all of one shape; NaN is gray
    label : the quantity of the scale, with its unit
    span : ends of the scale; by default all but 1 % of the pixels fit, and for a signed map the
        middle is 0
    signed : whether zero is white, and the two signs differ in color
    names : names of the classes, if v is an index into them

    Examples
    --------
    >>> figure = maps({"slope": np.arange(6.0).reshape(2, 3)}, label="stops")
    >>> [ax.get_title() for ax in figure.axes if ax.get_title()]
    ['slope']
    """
    arrays = _as_arrays(named_maps)
    norm, colors = _make_scale(arrays, span, signed, len(names))
    *map_axes, bar = _make_axes(arrays, has_titles=any(named_maps))
    for ax, name, v in zip(map_axes, named_maps, arrays, strict=True):
        nearest.show(ax, v, colours=colors, norm=norm)
        ax.set_title(name, fontsize=11, pad=4)
    _draw_scale(bar, norm, colors, names)
    bar.set_xlabel(label)
    return cast(Figure, bar.figure)


def _draw_scale(bar: Axes, norm: Normalize, colors: Any, names: Sequence[object]) -> None:
    """Draw the colors of a scale, with its numbers or the names of its classes below."""
    if names:
        low = -0.5
        high = len(names) - 0.5
        values = np.arange(len(names))
    else:
        low, high = norm.inverse(np.array([0.0, 1.0])).tolist()
        values = np.linspace(low, high, 256)
    image = nearest.show(bar, values[None], colours=colors, norm=norm, extent=(low, high, 0, 1))
    image.set_zorder(1)
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
    """Draw a histogram before the trims (pale) and after them, and the ceiling of the last trim.

    `top` fixes the end of the y axis, which taller bins exceed.
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
    ax.set(xlabel="brightness b = ln L", ylabel="foveal pixels h(b)", xlim=(b[0], b[-1]))
    ax.set_ylim(0, top or 1.02 * whole.max(initial=1))
    return with_legend(ax, "upper right")


def bands(
    spreads: Mapping[str, tuple[ArrayLike, ArrayLike, ArrayLike]], *, middle: float | None = None
) -> Axes:
    """Draw the display values of each luminance: a global curve is a line, a local operator a band.

    Each of `spreads` is (L, smallest Ld, largest Ld), as `tonemap.curves.spread` returns it.
    `middle` is the luminance at 0 stops, by default the median of the first L.
    """
    ax = axes()
    if not 0 < len(spreads) < len(LINE_STYLES):
        raise InputError(
            f"expected 1 to {len(LINE_STYLES) - 1} operators in one picture, got {len(spreads)}"
        )
    for (color, style), (name, (L, smallest, largest)) in zip(
        LINE_STYLES[1:], spreads.items(), strict=False
    ):
        L = np.asarray(L, np.float64)
        has_light = L > 0
        middle = middle or float(np.median(L[has_light]))
        low = 255 * encode_srgb(np.asarray(smallest)[has_light])
        high = 255 * encode_srgb(np.asarray(largest)[has_light])
        stops = np.log2(L[has_light] / middle)
        ax.fill_between(stops, low, high, color=color, alpha=0.3, linewidth=0)
        ax.plot(stops, low, linestyle=style, color=color, linewidth=1.2, label=name)
        ax.plot(stops, high, linestyle=style, color=color, linewidth=1.2)
    ax.set(xlabel="luminance, stops from the median", ylabel="display value", ylim=(-3, 258))
    return with_legend(ax, "upper left")


def _as_arrays(named_maps: Mapping[str, ArrayLike]) -> list[F64]:
    """Return the maps as arrays of at most MAX_MAP_SIDE pixels, or raise an InputError."""
    arrays = [np.asarray(v, np.float64) for v in named_maps.values()]
    is_alike = all(v.ndim == 2 and v.shape == arrays[0].shape for v in arrays)
    if not 1 <= len(arrays) <= 3 or not is_alike:
        got = ", ".join(describe(v) for v in arrays) or "none"
        raise InputError(f"expected one to three maps (H, W) of one shape, got {got}")
    return [figures.fit(v, MAX_MAP_SIDE) for v in arrays]


def _make_scale(
    arrays: list[F64], span: Ends, signed: bool, class_count: int
) -> tuple[Normalize, Any]:
    """Return the scale of values and the color map; NaN is gray."""
    name = SIGNED_COLOR_SCALE if signed else COLOR_SCALE
    colors = matplotlib.colormaps[name].with_extremes(bad=figures.MISSING_COLOR)
    if class_count:
        return BoundaryNorm(np.arange(class_count + 1) - 0.5, colors.N), colors
    if span is None:
        low, high = np.nanpercentile(np.stack(arrays), [0.5, 99.5])
        largest = max(-low, high)
        span = (-largest, largest) if signed else (low, high)
    low, high = span
    return Normalize(low, high if high > low else low + 1), colors


def _make_axes(arrays: list[F64], *, has_titles: bool) -> list[Axes]:
    """Return Axes for maps, and for their scale; several maps are narrower than a single one."""
    count = len(arrays)
    h, w = arrays[0].shape
    width = SINGLE_MAP_WIDTH if count == 1 else MAP_WIDTH * count
    map_width = (width - GAP_WIDTH * (count + 1)) / count
    map_height = map_width * h / w
    title_height = TITLE_HEIGHT if has_titles else NO_TITLE_HEIGHT
    height = title_height + map_height + SCALE_HEIGHT
    lefts = [GAP_WIDTH + k * (map_width + GAP_WIDTH) for k in range(count)]
    places = [
        (left / width, SCALE_HEIGHT / height, map_width / width, map_height / height)
        for left in lefts
    ]
    return scaled_axes(width, height, places, (0.08, 0.47 / height, 0.84, 0.14 / height))
