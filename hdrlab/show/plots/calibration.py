"""Describe and draw the result of a calibration: a response and its residuals.

g        response   (n,) or (n, 3), ln exposure of each pixel value, 0 at n // 2
medians  (P, C, 256), log2 exposure of each pixel value in each frame: see `diagnostics.consistency`

A stop is a factor of 2. Functions return text or figures; only `write_plot` writes a file.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hdrlab.core.arrays import F64, ArrayLike, Labels, as_table
from hdrlab.core.metrics import HIGH_LEVEL, LOW_LEVEL, RELIABLE_LEVELS
from hdrlab.diagnostics import consistency
from hdrlab.io.files import replacing, require_suffix
from hdrlab.io.own_pictures import SOFTWARE
from hdrlab.show import pictures, plots
from hdrlab.show.pages import templates, wording

PLOT_SUFFIXES = (".png", ".svg")
MIN_RESIDUAL_LIMIT = 0.1
# The y axis ends at this multiple of a quantile of the residuals, which ignores rare pixel values.
RESIDUAL_QUANTILE = 0.99
RESIDUAL_MARGIN = 1.5


@dataclass(frozen=True, kw_only=True)
class Reach:
    """The range of a response between two pixel values of 256 that occur in all channels.

    Attributes
    ----------
    low, high : the pixel values: those from LOW_LEVEL to HIGH_LEVEL, or fewer if not all occur
    stops : the range of each channel
    """

    low: int
    high: int
    stops: tuple[float, ...]

    def __str__(self) -> str:
        numbers = ", ".join(f"{stops:.1f}" for stops in self.stops)
        return f"{numbers} stops from pixel value {self.low} to {self.high}"


def find_drawn_levels(g: F64, medians: F64) -> Labels:
    """Return the first and the last pixel value of each curve to draw, (C, 2): those that occur.

    One curve for all channels is drawn where any channel has pixels.
    """
    levels = consistency.find_measured_levels(medians, len(g))
    if g.ndim == 1:
        return np.array([[levels[:, 0].min(), levels[:, 1].max()]], np.int32)
    return levels


def measure_reach(g: ArrayLike, medians: F64 | None) -> Reach:
    """Return the range of a response in stops, over pixel values that occur; None for all of them.

    Examples
    --------
    >>> g = np.log(np.maximum(np.arange(256), 0.25) / 128)
    >>> medians = np.full((2, 1, 256), np.nan)
    >>> medians[:, 0, 32:129] = 0
    >>> print(measure_reach(g, medians))
    2.0 stops from pixel value 32 to 128
    """
    curves = as_table(g, 256)
    curves = curves.reshape(len(curves), -1)
    low = LOW_LEVEL
    high = HIGH_LEVEL
    if medians is not None:
        levels = consistency.find_measured_levels(medians)
        low = max(low, int(levels[:, 0].max()))
        high = max(low, min(high, int(levels[:, 1].min())))
    stops = (curves[high] - curves[low]) / np.log(2)
    return Reach(low=low, high=high, stops=tuple(stops.tolist()))


def doublings(g: ArrayLike, low: int = LOW_LEVEL, high: int = 255) -> dict[int, float]:
    """Return {k: pixel value} at which a channel's exposure is 2^k times that of the middle value.

    Only pixel values from `low` to `high` of 256 count.

    Examples
    --------
    >>> doublings(np.log(np.maximum(np.arange(256), 0.25) / 128))[-3].__round__(3)
    16.0
    """
    curve = np.maximum.accumulate(np.asarray(g, np.float64)) / np.log(2)
    # Where a curve ends flat, its pixel values are not determined.
    last = int(np.argmax(curve == curve[-1]))
    lowest = int(np.ceil(curve[low * len(curve) // 256]))
    highest = int(np.floor(min(curve[last], curve[high * (len(curve) - 1) // 255])))
    levels = np.arange(last + 1)
    return {k: float(np.interp(k, curve[: last + 1], levels)) for k in range(lowest, highest + 1)}


def summary(g: F64, medians: F64, names: Sequence[str]) -> str:
    """Return the lines that describe a response and how well it fits the photos."""
    channels = [name for name, *_ in plots.CHANNELS] if g.ndim == 2 else ["gray"]
    reach = measure_reach(g, medians)
    rows = {}
    for channel, curve in zip(channels, np.atleast_2d(g.T), strict=True):
        rows[channel] = doublings(curve, reach.low, reach.high)
    deviations = np.nan_to_num(consistency.measure_deviations(medians))
    worst = int(np.argmax(np.abs(deviations)))
    text = templates.render_page(
        Path(__file__).parent,
        "calibration.plain",
        worst=names[worst],
        off=deviations[worst],
        low=reach.low,
        high=reach.high,
        rows=rows,
        stops=sorted(set().union(*rows.values())),
        reach=float(np.mean(reach.stops)),
        signed=wording.signed,
        spread=consistency.measure_spread(medians),
        rms=_rms(consistency.measure_residuals(medians, g)),
    )
    return text.rstrip()


def _rms(r: F64) -> float:
    """Return the root mean square residual of the pixel values 10 to 250, in stops; NaN for none."""
    reliable = r[..., RELIABLE_LEVELS]
    known = reliable[np.isfinite(reliable)]
    if not known.size:
        return float("nan")
    return float(np.sqrt(np.mean(known**2)))


def calibration(g: F64, medians: F64, exposures: Sequence[str], *, title: str = "") -> Figure:
    """Draw a response over the pixel values that occur, and the residuals of each frame next to it.

    `exposures` label the frames, see `plots.exposures`.
    """
    r = consistency.measure_residuals(medians, g)
    figure = Figure(figsize=(10.4, 4.2), dpi=100, layout="constrained")
    left, right = figure.subplots(1, 2)
    levels = find_drawn_levels(g, medians)
    reach = measure_reach(g, medians)
    plots.response(g, levels=levels, ax=left)
    left.set_title(title, fontsize=10)
    draw_residuals(r, exposures, ax=right)
    right.set_title("residuals of the frames, median of each pixel value", fontsize=10)
    for ax in figure.axes:
        ax.grid(color=plots.GRID_COLOR, linewidth=0.6)
    figure.set_label(
        f"{title}: the response over ln exposure, {reach}; "
        f"and the residuals of each frame, {_rms(r):.3f} stops rms"
    )
    return figure


def draw_residuals(r: F64, exposures: Sequence[str], *, ax: Axes | None = None) -> Axes:
    """Draw the residuals of each frame over pixel values, as the mean of the channels, in stops.

    `exposures` label the frames. Short exposures have dark lines.
    """
    ax = ax or plots.axes()
    lines = np.ma.masked_invalid(r).mean(axis=1)
    colors = matplotlib.colormaps["viridis"](np.linspace(0, 0.9, len(lines)))
    for line, exposure, color in zip(lines, exposures, colors, strict=True):
        ax.plot(np.arange(256), line, color=color, linewidth=1.1, label=exposure)
    sizes = np.ma.compressed(np.abs(lines[:, RELIABLE_LEVELS]))
    limit = MIN_RESIDUAL_LIMIT
    if len(sizes):
        limit = max(limit, RESIDUAL_MARGIN * float(np.quantile(sizes, RESIDUAL_QUANTILE)))
    ax.axhline(0, color=plots.BLACK, linewidth=0.8)
    ax.set(
        xlabel="pixel value Z",
        ylabel="g(Z) − ln E − ln t, stops",
        xlim=(0, 255),
        ylim=(-limit, limit),
    )
    for low, high in ((0, LOW_LEVEL), (HIGH_LEVEL, 255)):
        ax.axvspan(low, high, color="#EFEFEF", linewidth=0, zorder=0)
    ax.legend(fontsize=7, ncols=3, loc="lower center", framealpha=0.9)
    return ax


def write_plot(path: str | Path, figure: Figure) -> None:
    """Write a figure as .png or .svg, completely or not at all, with its alt text as "Description".

    Raises
    ------
    InputError
        For another suffix, or a figure without alt text.
    """
    suffix = check_suffix(path)
    metadata: dict[str, str | None] = {
        "Title": "Camera response",
        "Description": pictures.require_alt(str(figure.get_label())),
    }
    if suffix == ".svg":
        metadata["Date"] = None
    else:
        metadata["Software"] = SOFTWARE
    with replacing(path) as name, matplotlib.rc_context({"svg.hashsalt": "hdrlab"}):
        figure.savefig(name, format=suffix[1:], metadata=metadata)


def check_suffix(path: str | Path) -> str:
    """Return .png or .svg, or raise an InputError for another suffix."""
    return require_suffix(path, PLOT_SUFFIXES, "a plot")
