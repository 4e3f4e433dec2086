"""What a calibration found, in words and pictures: a response with its residuals, or many together.

g        response   (n,) or (n, 3), ln exposure of each pixel level, 0 at level n // 2
medians  (P, C, 256), log2 exposure of each level by each frame: see `diagnostics.consistency`
E        radiance   (H, W[, 3])

A stop is a factor of 2. Functions return lines of text or figures; only `write_plot` writes.
"""

from collections.abc import Mapping, Sequence
from itertools import combinations, cycle, islice
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hdrlab.core.arrays import as_table
from hdrlab.core.metrics import HIGH_LEVEL, LOW_LEVEL, RELIABLE_LEVELS, radiance_errors, response_rmse
from hdrlab.core.types import F32, F64, ArrayLike, Mask
from hdrlab.diagnostics import consistency
from hdrlab.io.files import replacing, require_suffix
from hdrlab.show import plots
from hdrlab.show.pages.wording import signed
from hdrlab.show.pictures import require_alt

SUFFIXES = (".png", ".svg")
COLOURS = ("#1A1A1A", "#D55E00", "#0072B2", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
# not as many as colours, so that no two look alike
STYLES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)))


def doublings(g: ArrayLike) -> dict[int, float]:
    """Return {k: level}, where one channel's exposure is 2^k times that of the middle level.

    Examples
    --------
    >>> doublings(np.log(np.maximum(np.arange(256), 0.25) / 128))[-3].__round__(3)
    16.0
    """
    curve = np.maximum.accumulate(np.asarray(g, np.float64)) / np.log(2)
    last = int(np.argmax(curve == curve[-1]))  # a flat end of a curve is not determined
    whole = range(int(np.ceil(curve[LOW_LEVEL * len(curve) // 256])), int(np.floor(curve[last])) + 1)
    return {k: float(np.interp(k, curve[: last + 1], np.arange(last + 1))) for k in whole}


def reach(g: ArrayLike) -> float:
    """Return how many stops lie between the levels 10 and 250 of 256, the mean of the channels."""
    curve = as_table(g, 256)
    return float(np.mean(curve[HIGH_LEVEL] - curve[LOW_LEVEL]) / np.log(2))


def summary(g: F64, medians: F64, names: Sequence[str]) -> list[str]:
    """Return the lines that describe a response and how well it explains the photographs."""
    channels = plots.CHANNELS if g.ndim == 2 else (("gray", "", ""),)
    found = [doublings(one) for one in np.atleast_2d(g.T)]
    stops = sorted(set().union(*found))
    lines = ["stops   " + "".join(f"{signed(k):>5}" for k in stops)]
    for (name, *_), levels in zip(channels, found, strict=True):
        row = "".join(f"{levels[k]:5.0f}" if k in levels else 5 * " " for k in stops)
        lines.append(f"{name:<8}{row}".rstrip())
    spread, off = consistency.measure_spread(medians), np.nan_to_num(consistency.measure_deviations(medians))
    worst = int(np.argmax(np.abs(off)))
    return [
        *lines,
        f"range      {reach(g):.2f} stops between the levels {LOW_LEVEL} and {HIGH_LEVEL}",
        f"spread     {f'{spread:.3f} stops' if np.isfinite(spread) else 'unknown'} between the frames' "
        "measurements of the same light",
        f"residuals  {_rms(consistency.measure_residuals(medians, g)):.3f} stops rms; furthest off is "
        f"{names[worst]}, by {signed(off[worst], 2)}",
    ]


def _rms(r: F64) -> float:
    """Return the root of the mean squared residual of the levels 10 to 250, in stops; NaN for none."""
    known = r[..., RELIABLE_LEVELS]
    known = known[np.isfinite(known)]
    return float(np.sqrt(np.mean(known**2))) if known.size else float("nan")


def matrix(names: Sequence[str], values: Mapping[tuple[str, str], float], digits: int = 2) -> list[str]:
    r"""Return a triangle of numbers, one for each pair of names, as lines of text.

    Examples
    --------
    >>> print("\n".join(matrix(["mann", "space"], {("mann", "space"): 1.234})[1:]))
    space     1.23
    """
    wide = max(map(len, names)) + 2
    lines = [" " * wide + "".join(f"{name:>{wide}}" for name in names[:-1])]
    for i, name in enumerate(names[1:], 1):
        row = "".join(f"{values[other, name]:{wide}.{digits}f}" for other in names[:i])
        lines.append(f"{name:<{wide}}{row}")
    return lines


def rmse(curves: Mapping[str, F64]) -> dict[tuple[str, str], float]:
    """Return how far each two responses lie apart: `response_rmse` in percent, of the worst channel."""

    def between(a: F64, b: F64) -> float:
        a, b = np.broadcast_arrays(_channels(a), _channels(b))
        return float(max(response_rmse(a, b).max(), response_rmse(b, a).max()))

    return {(one, other): between(curves[one], curves[other]) for one, other in combinations(curves, 2)}


def _channels(g: F64) -> F64:
    """Return g as a table (256, channels)."""
    return as_table(g, 256).reshape(256, -1)


def apart(maps: Mapping[str, F32], well: Mask) -> dict[tuple[str, str], float]:
    """Return by how many stops each two maps differ: the median over the well exposed pixels."""

    def between(E: F32, other: F32) -> float:
        ratio = 1 + radiance_errors(E, other, well)[well]
        return float(np.median(np.abs(np.log2(ratio[ratio > 0]))))

    return {(one, other): between(maps[one], maps[other]) for one, other in combinations(maps, 2)}


def calibration(g: F64, medians: F64, times: ArrayLike, *, title: str = "") -> Figure:
    """Draw a response, and next to it the residuals of each frame."""
    r = consistency.measure_residuals(medians, g)
    figure = Figure(figsize=(10.4, 4.2), dpi=100, layout="constrained")
    left, right = figure.subplots(1, 2)
    plots.response(g, ax=left)
    left.set_title(title, fontsize=10)
    draw_residuals(r, times, ax=right)
    right.set_title("residuals of the frames, median over a level's pixels", fontsize=10)
    for ax in figure.axes:
        ax.grid(color="#D9D9D9", linewidth=0.6)
    figure.set_label(
        f"{title}: the response over ln exposure, from {g.min():.1f} to {g.max():.1f}; "
        f"and what it leaves unexplained of each frame, {_rms(r):.3f} stops rms"
    )
    return figure


def _shade(ax: Axes) -> None:
    """Shade the levels below 10 and above 250, where no method is evaluated."""
    for low, high in ((0, LOW_LEVEL), (HIGH_LEVEL, 255)):
        ax.axvspan(low, high, color="#EFEFEF", linewidth=0, zorder=0)


def draw_residuals(r: F64, times: ArrayLike, *, ax: Axes | None = None) -> Axes:
    """Draw a line per frame, the channels' mean: pixel level across, stops up; dark lines are short times."""
    ax = ax or plots.axes()
    lines = np.ma.masked_invalid(r).mean(axis=1)
    colours = matplotlib.colormaps["viridis"](np.linspace(0, 0.9, len(lines)))
    for line, time, colour in zip(lines, np.asarray(times).tolist(), colours, strict=True):
        ax.plot(np.arange(256), line, color=colour, linewidth=1.1, label=plots.seconds(time))
    sizes = np.ma.compressed(np.abs(lines[:, RELIABLE_LEVELS]))
    most = max(0.1, 1.5 * float(np.quantile(sizes, 0.99))) if len(sizes) else 0.1  # but for rare levels
    ax.axhline(0, color="#1A1A1A", linewidth=0.8)
    ax.set(xlabel="pixel level Z", ylabel="g(Z) − ln E − ln t, stops", xlim=(0, 255), ylim=(-most, most))
    _shade(ax)
    ax.legend(fontsize=7, ncols=3, loc="lower center", framealpha=0.9)
    return ax


def overlay(curves: Mapping[str, F64], *, title: str = "") -> Figure:
    """Draw responses over each other, channel by channel, and below how far each is from their median."""
    tables = {name: _channels(g) for name, g in curves.items()}
    count = max(one.shape[1] for one in tables.values())
    figure = Figure(figsize=(2.2 + 4.2 * count, 6.8), dpi=100, layout="constrained")
    grid = figure.subplots(2, count, squeeze=False, sharey="row")
    looks = list(zip(tables.items(), islice(cycle(COLOURS), len(tables)), cycle(STYLES), strict=False))
    middle = np.median([np.broadcast_to(one, (256, count)) for one in tables.values()], axis=0) / np.log(2)
    span = (middle[3].min() - 1.5, middle[-1].max() + 1)  # noise rules below
    channels = plots.CHANNELS if count == 3 else (("gray", "", ""),)
    for c, (channel, *_) in enumerate(channels):
        above, below = grid[:, c]
        for (name, table), colour, style in looks:
            stops = table[:, min(c, table.shape[1] - 1)] / np.log(2)
            above.plot(stops, np.arange(256), color=colour, linestyle=style, linewidth=1.4, label=name)
            below.plot(np.arange(256), stops - middle[:, c], color=colour, linestyle=style, linewidth=1.2)
        above.set(title=channel, xlabel="exposure, stops from level 128", xlim=span, ylim=(-4, 259))
        below.set(xlabel="pixel level Z", xlim=(0, 255), ylim=(-1, 1))
        _shade(below)
    grid[0, 0].set_ylabel("pixel level Z")
    grid[1, 0].set_ylabel("stops from the methods' median")
    for ax in grid.flat:
        ax.grid(color="#D9D9D9", linewidth=0.6)
    figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside right center", frameon=False)
    figure.suptitle(title, fontsize=11)
    figure.set_label(
        f"{title}: responses over exposure in stops, found by {', '.join(tables)}; below, their differences"
    )
    return figure


def write_plot(path: str | Path, figure: Figure) -> None:
    """Write a figure as .png or .svg, whole or not at all, with its alt text inside as "Description".

    Raises
    ------
    ValueError
        For another suffix, or a figure without alt text.
    """
    suffix = check_suffix(path)
    said = {"Title": "Camera response", "Description": require_alt(str(figure.get_label()))}
    undated = said | ({"Date": None} if suffix == ".svg" else {})
    with replacing(path) as name, matplotlib.rc_context({"svg.hashsalt": "hdrlab"}):
        figure.savefig(name, format=suffix[1:], metadata=undated)


def check_suffix(path: str | Path) -> str:
    """Return .png or .svg, or raise a ValueError where a plot cannot be written under this name."""
    return require_suffix(path, SUFFIXES, "a plot")
