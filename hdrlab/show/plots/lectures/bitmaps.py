"""Alignment by bitmaps -> pictures and drawings: where two bitmaps differ, nine offsets at once, all.

bits     of one photograph   (2, H, W) bool: bitmap, and exclusion bitmap, True where compared
state    of `align.mtb`      one level of one pair
errors   (2 n + 1, 2 n + 1)  bits that differ / bits compared, dy down and dx across, -n to n pixels

Bits that agree are white or nearly black, those that differ orange, and what is not compared is
blue; in gray the four part as well.
"""

from collections.abc import Mapping
from textwrap import wrap

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from hdrlab.align import mtb
from hdrlab.capture.movers import shift_layer
from hdrlab.core.arrays import ArrayLike, Mask, NDArray, describe
from hdrlab.diagnostics.registration import Validation
from hdrlab.errors import InputError
from hdrlab.show.plots import nearest, picture_axes
from hdrlab.show.plots.lectures.offsets import WIDTH, draw_offsets

Offset = tuple[int, int]
AGREE = ((26, 26, 26), (255, 255, 255))  # both 0, both 1
DIFFER = (230, 159, 0)
OUTSIDE = (0, 90, 160)
CENTRE = "#808080"
BEST = "#D55E00"


def overlay(
    fixed: ArrayLike, moved: ArrayLike, compared: ArrayLike | None = None
) -> NDArray[np.uint8]:
    """Return two bitmaps (H, W) as one picture (H, W, 3); `compared` (H, W) is False where no bit counts."""
    a = np.asarray(fixed, bool)
    b = np.asarray(moved, bool)
    if (
        a.ndim != 2
        or a.shape != b.shape
        or (compared is not None and np.shape(compared) != a.shape)
    ):
        raise InputError(
            f"expected two bitmaps (H, W) of one size, got {describe(a)} and {describe(b)}"
        )
    picture = np.array(AGREE, np.uint8)[a.astype(int)]
    picture[a != b] = DIFFER
    if compared is not None:
        picture[~np.asarray(compared, bool)] = OUTSIDE
    return picture


def difference(fixed: Mask, moving: Mask, offset: Offset, *, title: str = "") -> Axes:
    """Draw the difference of two photographs' bits, the second moved by an offset, under its error."""
    ax = _under(fixed.shape[1] / fixed.shape[2], above=0.32 + 0.21 * title.count("\n"))
    nearest.show(ax, _picture(fixed, moving, offset))
    off = 100 * mtb.error(fixed, moving, offset)
    ax.set_title(title or f"moved by {_pair(offset)}: {off:.2f} % of the bits differ", fontsize=11)
    return ax


def validated(state: mtb.State, validation: Validation) -> Axes:
    """Draw what still differs at the end of a search, under what was found and why not to trust it."""
    found = f"found {_pair(state.offset)}, {100 * validation.after:.2f} % of the bits differ"
    said = wrap(validation.failure or "no reason not to trust it", 68)
    title = "\n".join([found, *said, *[""] * (2 - len(said))])  # of one height, whatever it says
    return difference(state.fixed, state.moving, state.offset, title=title)


def nine(state: mtb.State) -> Figure:
    """Return the nine offsets that a level compares, the centre in a gray frame and the best in an orange."""
    (height, width) = state.fixed.shape[1:]
    gap = 0.06
    centre = next(iter(state.errors))
    side = (WIDTH - 4 * gap) / 3
    tall = side * height / width
    figure = Figure(figsize=(WIDTH, 3 * (tall + 0.25) + 0.45), dpi=100)
    total = figure.get_size_inches()[1]
    for offset, error in sorted(state.errors.items()):
        row = offset[0] - centre[0] + 1
        column = offset[1] - centre[1] + 1
        left = gap + column * (side + gap)
        top = 0.4 + row * (tall + 0.25)
        place = (left / WIDTH, 1 - (top + 0.22 + tall) / total, side / WIDTH, tall / total)
        ax = figure.add_axes(place)
        nearest.show(ax, _picture(state.fixed, state.moving, offset))
        ax.set_title(f"{_pair(offset)}: {100 * error:.2f} %", fontsize=10, pad=2)
        ax.set(xticks=(), yticks=())
        framed = BEST if offset == state.offset else CENTRE if offset == centre else "#D9D9D9"
        for edge in ax.spines.values():
            edge.set(color=framed, linewidth=1 if framed == "#D9D9D9" else 3)
    said = f"level {state.level}, {width} × {height} pixels: offsets (dy, dx), and how many bits differ"
    figure.suptitle(said, fontsize=11, y=1 - 0.12 / total, va="top")
    return figure


def surface(errors: ArrayLike, *, marks: Mapping[str, Offset] | None = None) -> Figure:
    """Return the errors of all offsets as a map, with named offsets marked on it."""
    found = np.asarray(errors, np.float64)
    if found.ndim != 2 or found.shape[0] != found.shape[1] or len(found) % 2 == 0:
        raise InputError(f"expected errors (2 n + 1, 2 n + 1), got {describe(found)}")
    return draw_offsets(100 * found, "bits that differ, %", marks)


def words(rows: dict[str, ArrayLike]) -> Figure:
    """Return rows of bits, each under the other beside its name: 1 is white and 0 dark, as in pictures."""
    each = {name: np.asarray(row, bool) for name, row in rows.items()}
    lengths = {row.shape for row in each.values()}
    if len(lengths) != 1 or len(next(iter(lengths))) != 1:
        raise InputError(f"expected rows of one length, got {sorted(lengths)}")
    (count,) = next(iter(lengths))
    figure = Figure(figsize=(WIDTH, 0.34 * len(each) + 0.15), dpi=100)
    ax = figure.add_axes((0.26, 0.03, 0.73, 0.94))
    for y, row in enumerate(each.values()):
        for x, bit in enumerate(row.tolist()):
            ax.add_patch(
                Rectangle((x, y), 1, 1, facecolor="#FFFFFF" if bit else "#404040", edgecolor=CENTRE)
            )
            dark = "#1A1A1A" if bit else "#FFFFFF"
            ax.text(
                x + 0.5, y + 0.5, str(int(bit)), color=dark, fontsize=10, ha="center", va="center"
            )
    ax.set(xlim=(-0.1, count + 0.1), ylim=(len(each) + 0.1, -0.1), xticks=())
    ax.set_yticks(np.arange(len(each)) + 0.5, list(each), fontsize=10)
    ax.tick_params(length=0)
    for edge in ax.spines.values():
        edge.set_visible(False)
    return figure


def _picture(fixed: Mask, moving: Mask, offset: Offset) -> NDArray[np.uint8]:
    bits, kept = (shift_layer(one, offset) for one in moving)
    return overlay(fixed[0], bits, fixed[1] & kept)


def _under(ratio: float, *, above: float) -> Axes:
    """Return bare Axes for a picture of this height over width, with room for a title."""
    tall = (WIDTH - 0.1) * ratio
    total = tall + above + 0.05
    return picture_axes(WIDTH, total, (0.05 / WIDTH, 0.05 / total, 1 - 0.1 / WIDTH, tall / total))


def _pair(offset: Offset) -> str:
    return "({:d}, {:d})".format(*offset)
