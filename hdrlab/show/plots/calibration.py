"""What a calibration found, in words and pictures: a response with its residuals.

g        response   (n,) or (n, 3), ln exposure of each pixel level, 0 at level n // 2
medians  (P, C, 256), log2 exposure of each level by each frame: see `diagnostics.consistency`

A stop is a factor of 2. Functions return lines of text or figures; only `write_plot` writes.
"""

from collections.abc import Sequence
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hdrlab.core.arrays import F64, ArrayLike, as_table
from hdrlab.core.metrics import HIGH_LEVEL, LOW_LEVEL, RELIABLE_LEVELS
from hdrlab.diagnostics import consistency
from hdrlab.io.files import replacing, require_suffix
from hdrlab.show import pictures, plots
from hdrlab.show.pages import templates, wording

SUFFIXES = (".png", ".svg")


def doublings(g: ArrayLike) -> dict[int, float]:
    """Return {k: level}, where one channel's exposure is 2^k times that of the middle level.

    Examples
    --------
    >>> doublings(np.log(np.maximum(np.arange(256), 0.25) / 128))[-3].__round__(3)
    16.0
    """
    curve = np.maximum.accumulate(np.asarray(g, np.float64)) / np.log(2)
    last = int(np.argmax(curve == curve[-1]))  # a flat end of a curve is not determined
    whole = range(
        int(np.ceil(curve[LOW_LEVEL * len(curve) // 256])), int(np.floor(curve[last])) + 1
    )
    return {k: float(np.interp(k, curve[: last + 1], np.arange(last + 1))) for k in whole}


def reach(g: ArrayLike) -> float:
    """Return how many stops lie between the levels 10 and 250 of 256, the mean of the channels."""
    curve = as_table(g, 256)
    return float(np.mean(curve[HIGH_LEVEL] - curve[LOW_LEVEL]) / np.log(2))


def summary(g: F64, medians: F64, names: Sequence[str]) -> str:
    """Return the lines that describe a response and how well it explains the photographs."""
    channels = [name for name, *_ in plots.CHANNELS] if g.ndim == 2 else ["gray"]
    rows = dict(zip(channels, map(doublings, np.atleast_2d(g.T)), strict=True))
    off = np.nan_to_num(consistency.measure_deviations(medians))
    worst = int(np.argmax(np.abs(off)))
    words = {
        "worst": names[worst],
        "off": off[worst],
        "low": LOW_LEVEL,
        "high": HIGH_LEVEL,
        "rows": rows,
    }
    words |= {
        "stops": sorted(set().union(*rows.values())),
        "reach": reach(g),
        "signed": wording.signed,
    }
    words |= {"spread": consistency.measure_spread(medians)}
    words |= {"rms": _rms(consistency.measure_residuals(medians, g))}
    return templates.render_page(Path(__file__).parent, "calibration.plain", **words).rstrip()


def _rms(r: F64) -> float:
    """Return the root of the mean squared residual of the levels 10 to 250, in stops; NaN for none."""
    known = r[..., RELIABLE_LEVELS]
    known = known[np.isfinite(known)]
    return float(np.sqrt(np.mean(known**2))) if known.size else float("nan")


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


def draw_residuals(r: F64, times: ArrayLike, *, ax: Axes | None = None) -> Axes:
    """Draw a line per frame, the channels' mean: pixel level across, stops up; dark lines are short times."""
    ax = ax or plots.axes()
    lines = np.ma.masked_invalid(r).mean(axis=1)
    colours = matplotlib.colormaps["viridis"](np.linspace(0, 0.9, len(lines)))
    for line, time, colour in zip(lines, np.asarray(times).tolist(), colours, strict=True):
        ax.plot(np.arange(256), line, color=colour, linewidth=1.1, label=plots.seconds(time))
    sizes = np.ma.compressed(np.abs(lines[:, RELIABLE_LEVELS]))
    # but for rare levels
    most = max(0.1, 1.5 * float(np.quantile(sizes, 0.99))) if len(sizes) else 0.1
    ax.axhline(0, color="#1A1A1A", linewidth=0.8)
    ax.set(
        xlabel="pixel level Z",
        ylabel="g(Z) − ln E − ln t, stops",
        xlim=(0, 255),
        ylim=(-most, most),
    )
    for low, high in ((0, LOW_LEVEL), (HIGH_LEVEL, 255)):
        ax.axvspan(low, high, color="#EFEFEF", linewidth=0, zorder=0)
    ax.legend(fontsize=7, ncols=3, loc="lower center", framealpha=0.9)
    return ax


def write_plot(path: str | Path, figure: Figure) -> None:
    """Write a figure as .png or .svg, whole or not at all, with its alt text inside as "Description".

    Raises
    ------
    ValueError
        For another suffix, or a figure without alt text.
    """
    suffix = check_suffix(path)
    said = {
        "Title": "Camera response",
        "Description": pictures.require_alt(str(figure.get_label())),
    }
    undated = said | ({"Date": None} if suffix == ".svg" else {})
    with replacing(path) as name, matplotlib.rc_context({"svg.hashsalt": "hdrlab"}):
        figure.savefig(name, format=suffix[1:], metadata=undated)


def check_suffix(path: str | Path) -> str:
    """Return .png or .svg, or raise a ValueError where a plot cannot be written under this name."""
    return require_suffix(path, SUFFIXES, "a plot")
