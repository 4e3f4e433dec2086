"""Draw alignment by bitmaps: differing bits, the nine offsets of a level, errors of all offsets.

bits     of one photo        (2, H, W) bool: bitmap, and exclusion bitmap, True where compared
state    of `align.mtb`      one level of one pair
errors   (2 n + 1, 2 n + 1)  bits that differ / bits compared, at offsets (dy, dx) from -n to n

Bits that agree are white or nearly black, bits that differ are orange, and bits that are not
compared are blue. The four colors also differ in gray.
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
from hdrlab.show.plots import BLACK, nearest, picture_axes
from hdrlab.show.plots.lectures.offsets import WIDTH_INCHES, draw_offsets

Offset = tuple[int, int]
# The colors of bits that are both 0, and of bits that are both 1.
EQUAL_BIT_COLORS = ((26, 26, 26), (255, 255, 255))
DIFFERENT_BIT_COLOR = (230, 159, 0)
EXCLUDED_BIT_COLOR = (0, 90, 160)
CENTER_COLOR = "#808080"
BEST_OFFSET_COLOR = "#D55E00"
OTHER_OFFSET_COLOR = "#D9D9D9"
# All titles of `validated` have this number of lines, so that a slider does not move the image.
FAILURE_LINES = 2
FAILURE_LINE_LETTERS = 68


def overlay(
    fixed: ArrayLike, moved: ArrayLike, compared: ArrayLike | None = None
) -> NDArray[np.uint8]:
    """Return two bitmaps (H, W) as one image (H, W, 3); `compared` is False for excluded bits."""
    a = np.asarray(fixed, bool)
    b = np.asarray(moved, bool)
    has_other_mask = compared is not None and np.shape(compared) != a.shape
    if a.ndim != 2 or a.shape != b.shape or has_other_mask:
        raise InputError(
            f"expected two bitmaps (H, W) of one size, got {describe(a)} and {describe(b)}"
        )
    image = np.array(EQUAL_BIT_COLORS, np.uint8)[a.astype(int)]
    image[a != b] = DIFFERENT_BIT_COLOR
    if compared is not None:
        image[~np.asarray(compared, bool)] = EXCLUDED_BIT_COLOR
    return image


def difference(fixed: Mask, moving: Mask, offset: Offset, *, title: str = "") -> Axes:
    """Draw the difference of two photos' bits after an offset, with the error as its title."""
    height, width = fixed.shape[1:]
    ax = _titled_axes(height / width, title_height=0.32 + 0.21 * title.count("\n"))
    nearest.show(ax, _overlay_at(fixed, moving, offset))
    percent = 100 * mtb.error(fixed, moving, offset)
    default_title = f"moved by {_format_offset(offset)}: {percent:.2f} % of the bits differ"
    ax.set_title(title or default_title, fontsize=11)
    return ax


def validated(state: mtb.State, validation: Validation) -> Axes:
    """Draw the remaining difference after a search, with its result and why it may be wrong."""
    percent = 100 * validation.after
    result = f"found {_format_offset(state.offset)}, {percent:.2f} % of the bits differ"
    lines = [result, *wrap(validation.failure or "the result is plausible", FAILURE_LINE_LETTERS)]
    while len(lines) < 1 + FAILURE_LINES:
        lines.append("")
    return difference(state.fixed, state.moving, state.offset, title="\n".join(lines))


def nine(state: mtb.State) -> Figure:
    """Draw the nine offsets of a level, the center in a gray frame and the best in an orange one."""
    height, width = state.fixed.shape[1:]
    gap = 0.06
    center = next(iter(state.errors))
    image_width = (WIDTH_INCHES - 4 * gap) / 3
    image_height = image_width * height / width
    figure_height = 3 * (image_height + 0.25) + 0.45
    figure = Figure(figsize=(WIDTH_INCHES, figure_height), dpi=100)
    for offset, error in sorted(state.errors.items()):
        row = offset[0] - center[0] + 1
        column = offset[1] - center[1] + 1
        left = gap + column * (image_width + gap)
        top = 0.4 + row * (image_height + 0.25)
        place = (
            left / WIDTH_INCHES,
            1 - (top + 0.22 + image_height) / figure_height,
            image_width / WIDTH_INCHES,
            image_height / figure_height,
        )
        ax = figure.add_axes(place)
        nearest.show(ax, _overlay_at(state.fixed, state.moving, offset))
        ax.set_title(f"{_format_offset(offset)}: {100 * error:.2f} %", fontsize=10, pad=2)
        ax.set(xticks=(), yticks=())
        color = OTHER_OFFSET_COLOR
        line_width = 1
        if offset == state.offset:
            color = BEST_OFFSET_COLOR
            line_width = 3
        elif offset == center:
            color = CENTER_COLOR
            line_width = 3
        for spine in ax.spines.values():
            spine.set(color=color, linewidth=line_width)
    size = f"level {state.level}, {width} × {height} pixels"
    title = f"{size}: offsets (dy, dx) and the fraction of bits that differ"
    figure.suptitle(title, fontsize=11, y=1 - 0.12 / figure_height, va="top")
    return figure


def surface(errors: ArrayLike, *, marks: Mapping[str, Offset] | None = None) -> Figure:
    """Draw the errors of all offsets as a map, with named offsets marked on it."""
    errors = np.asarray(errors, np.float64)
    if errors.ndim != 2 or errors.shape[0] != errors.shape[1] or len(errors) % 2 == 0:
        raise InputError(f"expected errors (2 n + 1, 2 n + 1), got {describe(errors)}")
    return draw_offsets(100 * errors, "bits that differ, %", marks)


def words(rows: dict[str, ArrayLike]) -> Figure:
    """Draw rows of bits with their names: 1 is white and 0 dark, as in bitmaps."""
    bit_rows = {name: np.asarray(row, bool) for name, row in rows.items()}
    shapes = {row.shape for row in bit_rows.values()}
    if len(shapes) != 1 or len(next(iter(shapes))) != 1:
        raise InputError(f"expected rows of one length, got {sorted(shapes)}")
    count = len(next(iter(bit_rows.values())))
    figure = Figure(figsize=(WIDTH_INCHES, 0.34 * len(bit_rows) + 0.15), dpi=100)
    ax = figure.add_axes((0.26, 0.03, 0.73, 0.94))
    for y, row in enumerate(bit_rows.values()):
        for x, bit in enumerate(row.tolist()):
            box_color = "#FFFFFF" if bit else "#404040"
            text_color = BLACK if bit else "#FFFFFF"
            ax.add_patch(Rectangle((x, y), 1, 1, facecolor=box_color, edgecolor=CENTER_COLOR))
            ax.text(
                x + 0.5,
                y + 0.5,
                str(int(bit)),
                color=text_color,
                fontsize=10,
                ha="center",
                va="center",
            )
    ax.set(xlim=(-0.1, count + 0.1), ylim=(len(bit_rows) + 0.1, -0.1), xticks=())
    ax.set_yticks(np.arange(len(bit_rows)) + 0.5, list(bit_rows), fontsize=10)
    ax.tick_params(length=0)
    for spine in ax.spines.values():
        spine.set_visible(False)
    return figure


def _overlay_at(fixed: Mask, moving: Mask, offset: Offset) -> NDArray[np.uint8]:
    """Return the overlay of two photos' bits, the second moved by an offset."""
    bits = shift_layer(moving[0], offset)
    is_compared = shift_layer(moving[1], offset)
    return overlay(fixed[0], bits, fixed[1] & is_compared)


def _titled_axes(ratio: float, *, title_height: float) -> Axes:
    """Return bare Axes for an image with this ratio of height to width, and room for a title."""
    image_height = (WIDTH_INCHES - 0.1) * ratio
    height = image_height + title_height + 0.05
    place = (
        0.05 / WIDTH_INCHES,
        0.05 / height,
        1 - 0.1 / WIDTH_INCHES,
        image_height / height,
    )
    return picture_axes(WIDTH_INCHES, height, place)


def _format_offset(offset: Offset) -> str:
    dy, dx = offset
    return f"({dy:d}, {dx:d})"
