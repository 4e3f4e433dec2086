"""Draw registration by light: differences, correlation at every shift, and errors of the simplex.

X      light               (2, h, w): a fixed and a moving photo on one scale, NaN where discarded
H      homography          (3, 3): the place in the fixed photo of pixel (x, y, 1) of the moving one
d      difference          (a - b) / mean of the two
state  of `align.cerman`   one level of one pair

Differences are orange where the fixed photo is brighter, violet where the moving one is, white where
they agree, and gray where one of them has no data.
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
from hdrlab.show.plots.lectures.offsets import WIDTH_INCHES, draw_offsets

# The color scale ends where one photo is 1.86 times as bright as the other.
MAX_SHOWN_DIFFERENCE = 0.6
COLOR_SCALE = "PuOr_r"
LINE_COLOR = "#0072B2"
END_COLOR = "#D55E00"


def differences(X: ArrayLike, H: ArrayLike) -> tuple[F64, float]:
    """Return d of every pixel (h, w), and the error e."""
    light = np.asarray(X, np.float32)
    if light.ndim != 3 or len(light) != 2:
        raise InputError(f"expected the light of two photographs (2, h, w), got {describe(light)}")
    p = lattice(light.shape[1:], light[0].size)
    d = compare(light, np.asarray(H, float), p)
    return d.reshape(light.shape[1:]), error(d)


def difference(X: ArrayLike, H: ArrayLike, *, title: str = "") -> Axes:
    """Draw the difference of two photos, the second moved by H, with the error as its title."""
    d, e = differences(X, H)
    tall = WIDTH_INCHES * d.shape[0] / d.shape[1]
    ax = picture_axes(WIDTH_INCHES, tall + 0.4, (0, 0, 1, tall / (tall + 0.4)))
    nearest.show(
        ax,
        figures.false_colour(d, -MAX_SHOWN_DIFFERENCE, MAX_SHOWN_DIFFERENCE, colours=COLOR_SCALE),
    )
    ax.set_title(f"{title}error e = {e:.4f}", fontsize=11)
    return ax


def correlation(c: ArrayLike, *, marks: Mapping[str, tuple[float, float]] | None = None) -> Figure:
    """Draw the correlation at every shift as a map, with named shifts (dy, dx) marked on it."""
    c = np.asarray(c, np.float64)
    if c.ndim != 2 or c.shape[0] % 2 == 0 or c.shape[1] % 2 == 0:
        raise InputError(f"expected the correlation at shifts -n to n, got {describe(c)}")
    return draw_offsets(c / np.abs(c).max(), "correlation / maximum", marks)


def level(state: State) -> Figure:
    """Draw the difference at the end of a level's simplex, and the error of each step."""
    d = differences(state.X, state.H)[0]
    tall = WIDTH_INCHES * d.shape[0] / d.shape[1]
    total = tall + 2.3
    figure = Figure(figsize=(WIDTH_INCHES, total), dpi=100)
    above = figure.add_axes((0, 1.9 / total, 1, tall / total))
    nearest.show(
        above,
        figures.false_colour(d, -MAX_SHOWN_DIFFERENCE, MAX_SHOWN_DIFFERENCE, colours=COLOR_SCALE),
    )
    bare(above)
    size = f"{d.shape[1]} × {d.shape[0]} pixels"
    above.set_title(f"level {state.level}, {size}: error e = {state.errors[-1]:.4f}", fontsize=11)
    ax = figure.add_axes((0.14, 0.5 / total, 0.83, 1.25 / total))
    e = 1000 * state.errors
    ax.plot(e, color=LINE_COLOR, linewidth=1.8)
    ax.plot(len(e) - 1, e[-1], "o", color=END_COLOR)
    ax.set(xlabel="step of the simplex", ylabel="1000 e", ylim=(0, 1.1 * e.max() + 1e-6))
    ax.grid(alpha=0.3)
    return figure
