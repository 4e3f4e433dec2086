"""Registration by light, drawn: what differs after a move, correlation at every shift, the simplex's way.

X      light               (2, h, w): a fixed and a moving photograph on one scale, NaN where discarded
H      homography          (3, 3): where pixel (x, y, 1) of the moving photograph lies on the fixed one
d      difference          (a - b) / mean of the two: orange where the fixed one is brighter, violet where the
                           moving one is, white where they agree, gray where one of them shows
                           nothing
state  of `align.cerman`   one level of one pair
"""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hdrlab.align.cerman import State
from hdrlab.align.light import differences as compare, error, lattice
from hdrlab.core.arrays import F64, ArrayLike, describe
from hdrlab.errors import InputError
from hdrlab.show.plots import bare, figures, nearest, picture_axes
from hdrlab.show.plots.lectures.offsets import WIDTH, draw_offsets

REACH = 0.6  # d at which the colours end: one photograph 1.86 times as bright as the other
COLOURS = "PuOr_r"
LINE = "#0072B2"
POINT = "#D55E00"


def differences(X: ArrayLike, H: ArrayLike) -> tuple[F64, float]:
    """Return d of every pixel (h, w), and the error e."""
    light = np.asarray(X, np.float32)
    if light.ndim != 3 or len(light) != 2:
        raise InputError(f"expected the light of two photographs (2, h, w), got {describe(light)}")
    p = lattice(light.shape[1:], light[0].size)
    d = compare(light, np.asarray(H, float), p)
    return d.reshape(light.shape[1:]), error(d)


def difference(X: ArrayLike, H: ArrayLike, *, title: str = "") -> Axes:
    """Draw what differs between two photographs, the second moved by H, under its error."""
    d, e = differences(X, H)
    tall = WIDTH * d.shape[0] / d.shape[1]
    ax = picture_axes(WIDTH, tall + 0.4, (0, 0, 1, tall / (tall + 0.4)))
    nearest.show(ax, figures.false_colour(d, -REACH, REACH, colours=COLOURS))
    ax.set_title(f"{title}error e = {e:.4f}", fontsize=11)
    return ax


def correlation(c: ArrayLike, *, marks: Mapping[str, tuple[float, float]] | None = None) -> Figure:
    """Return the correlation at every shift as a map, with named shifts (dy, dx) marked on it."""
    found = np.asarray(c, np.float64)
    if found.ndim != 2 or found.shape[0] % 2 == 0 or found.shape[1] % 2 == 0:
        raise InputError(f"expected the correlation at shifts -n to n, got {describe(found)}")
    return draw_offsets(found / np.abs(found).max(), "correlation / its largest", marks)


def level(state: State) -> Figure:
    """Return what differs where a level's simplex ended, and how the error fell on the way."""
    d, found = differences(state.X, state.H)
    tall = WIDTH * d.shape[0] / d.shape[1]
    total = tall + 2.3
    figure = Figure(figsize=(WIDTH, total), dpi=100)
    above = figure.add_axes((0, 1.9 / total, 1, tall / total))
    nearest.show(above, figures.false_colour(d, -REACH, REACH, colours=COLOURS))
    bare(above)
    size = f"{d.shape[1]} × {d.shape[0]} pixels"
    above.set_title(f"level {state.level}, {size}: error e = {found:.4f}", fontsize=11)
    ax = figure.add_axes((0.14, 0.5 / total, 0.83, 1.25 / total))
    e = 1000 * state.errors
    ax.plot(e, color=LINE, linewidth=1.8)
    ax.plot(len(e) - 1, e[-1], "o", color=POINT)
    ax.set(xlabel="step of the simplex", ylabel="1000 e", ylim=(0, 1.1 * e.max() + 1e-6))
    ax.grid(alpha=0.3)
    return figure
