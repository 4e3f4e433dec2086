"""Draw the contact sheet: tone-mapped pictures of one scene, with their statistics.

Q, S, N  TMQI: overall, structural fidelity, naturalness, see `tonemap.quality`

Pictures are placed at whole pixels, so a picture that already has the sheet's size is not resampled.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hdrlab.core.picture import Statistics
from hdrlab.errors import InputError
from hdrlab.io.files import replacing, require_suffix
from hdrlab.io.own_pictures import SOFTWARE
from hdrlab.show.pictures import require_alt
from hdrlab.tonemap.quality import Quality

# Lengths are in pixels of the sheet.
PIXELS_PER_INCH = 100
PICTURE_SIDE = 480
MIN_TEXT_WIDTH = 320
CAPTION_HEIGHT = 86
GAP_WIDTH = 14
TITLE_TOP = 12
TITLE_MARGIN = 24
TITLE_LINE_HEIGHT = 20
TITLE_LETTER_WIDTH = 12
LEGEND_MARGIN = 16
LEGEND_LINE_HEIGHT = 14
LEGEND_LETTER_WIDTH = 7
# The width of a sheet divided by its height, if `columns` is not given.
ASPECT_RATIO = 1.6
LEGEND_FILE = Path(__file__).with_name("sheet_legend.txt")
MIN_SECONDS_UNIT = 0.9995
MIN_WHOLE_MILLISECONDS = 0.00095


@dataclass(frozen=True)
class Entry:
    """One picture of the sheet.

    Attributes
    ----------
    name : the operator's name
    picture : (H, W) or (H, W, 3) uint8, sRGB
    seconds : the operator's running time
    quality : Q, S, N
    statistics : black, white, mean, contrast, entropy
    """

    name: str
    picture: NDArray[np.uint8]
    seconds: float
    quality: Quality
    statistics: Statistics


def caption(entry: Entry) -> str:
    """Return the three lines under a picture.

    Examples
    --------
    >>> quality = Quality(0.934, 0.87, 0.81)
    >>> statistics = Statistics(0.001, 0.0464, 128.6, 40.4, 7.36)
    >>> print(caption(Entry("reinhard", np.zeros((1, 1), np.uint8), 0.0342, quality, statistics)))
    Q 0.934   S 0.870   N 0.810   34 ms
    black 0.10 %   clipped 4.64 %
    mean 129   contrast 40   entropy 7.36 bits
    """
    tmqi = entry.quality
    statistics = entry.statistics
    black = 100 * statistics.black
    clipped = 100 * statistics.white
    mean = statistics.mean
    contrast = statistics.contrast
    entropy = statistics.entropy
    return (
        f"Q {tmqi.Q:.3f}   S {tmqi.S:.3f}   N {tmqi.N:.3f}   {format_time(entry.seconds)}\n"
        f"black {black:.2f} %   clipped {clipped:.2f} %\n"
        f"mean {mean:.0f}   contrast {contrast:.0f}   entropy {entropy:.2f} bits"
    )


def format_time(seconds: float) -> str:
    """Return a running time as '34 ms' or '1.2 s'.

    Examples
    --------
    >>> format_time(0.0342), format_time(1.234), format_time(0.0002)
    ('34 ms', '1.2 s', '0.2 ms')
    """
    if seconds >= MIN_SECONDS_UNIT:
        return f"{seconds:.1f} s"
    if seconds >= MIN_WHOLE_MILLISECONDS:
        return f"{1000 * seconds:.0f} ms"
    return f"{1000 * seconds:.1g} ms"


def alt_text(entries: Sequence[Entry], title: str = "") -> str:
    """Return the alt text of the sheet: the name and all numbers of each picture, best TMQI first."""
    ranked = sorted(entries, key=lambda entry: -entry.quality.Q)
    descriptions = []
    for entry in ranked:
        numbers = ", ".join(caption(entry).splitlines())
        descriptions.append(" ".join(f"{entry.name}: {numbers}".split()))
    subject = f" of {title}" if title else ""
    return (
        f"Contact sheet{subject}: one scene through {len(ranked)} tone-mapping operators, "
        f"best TMQI first. {'; '.join(descriptions)}."
    )


@dataclass(frozen=True)
class _Layout:
    """The grid of a sheet: pictures in a row, and the sizes of a picture and of its cell."""

    columns: int
    picture_width: int
    picture_height: int
    cell_width: int
    cell_height: int


def _make_layout(shape: tuple[int, ...], count: int, columns: int | None) -> _Layout:
    """Return the grid for `count` pictures of a shape, by default of a sheet wider than tall."""
    h, w = shape[:2]
    picture_width = max(1, round(PICTURE_SIDE * w / max(h, w)))
    picture_height = max(1, round(PICTURE_SIDE * h / max(h, w)))
    cell_width = max(picture_width, MIN_TEXT_WIDTH) + GAP_WIDTH
    cell_height = picture_height + CAPTION_HEIGHT
    if columns is None:
        columns = max(1, round((ASPECT_RATIO * count * cell_height / cell_width) ** 0.5))
        rows = -(-count // columns)
        # The same number of rows often needs fewer columns, which leaves fewer cells empty.
        columns = -(-count // rows)
    return _Layout(
        columns=min(columns, count),
        picture_width=picture_width,
        picture_height=picture_height,
        cell_width=cell_width,
        cell_height=cell_height,
    )


def draw(entries: Iterable[Entry], *, title: str = "", columns: int | None = None) -> Figure:
    """Draw the sheet of the entries, in their order; the figure's label is its alt text.

    Parameters
    ----------
    entries : pictures of one size, with their statistics
    title : above the sheet, and in its alt text
    columns : pictures in a row; by default so many that the sheet is wider than tall
    """
    entries = list(entries)
    if not entries:
        raise InputError("expected at least one picture for the sheet, got none")
    if columns is not None and columns < 1:
        raise InputError(f"expected columns >= 1, got {columns}")
    layout = _make_layout(entries[0].picture.shape, len(entries), columns)
    rows = -(-len(entries) // layout.columns)
    width = layout.columns * layout.cell_width + GAP_WIDTH
    title_lines = _wrap(title or "Tone mapping", width, TITLE_LETTER_WIDTH)
    legend_lines = _wrap(LEGEND_FILE.read_text("utf8"), width, LEGEND_LETTER_WIDTH)
    pictures_top = TITLE_MARGIN + TITLE_LINE_HEIGHT * len(title_lines)
    legend_top = pictures_top + rows * layout.cell_height
    height = legend_top + LEGEND_MARGIN + LEGEND_LINE_HEIGHT * len(legend_lines)
    size = (width / PIXELS_PER_INCH, height / PIXELS_PER_INCH)
    figure = Figure(figsize=size, dpi=PIXELS_PER_INCH, facecolor="white")
    figure.set_label(alt_text(entries, title))
    _write(figure, GAP_WIDTH, TITLE_TOP, "\n".join(title_lines), fontsize=13, fontweight="bold")
    for i, entry in enumerate(entries):
        row, column = divmod(i, layout.columns)
        left = GAP_WIDTH + column * layout.cell_width
        top = pictures_top + row * layout.cell_height
        _draw_entry(figure, entry, left, top, layout)
    _write(figure, GAP_WIDTH, legend_top, "\n".join(legend_lines), fontsize=8, color="#404040")
    return figure


def write_sheet(path: str | Path, sheet: Figure) -> None:
    """Write a sheet as PNG, completely or not at all, with its alt text in the chunk "Description".

    Raises
    ------
    InputError
        For another suffix than .png, or a figure without alt text.
    """
    check_suffix(path)
    alt = require_alt(str(sheet.get_label()))
    metadata = {"Title": "Contact sheet", "Description": alt, "Software": SOFTWARE}
    with replacing(path) as name:
        sheet.savefig(name, format="png", dpi=PIXELS_PER_INCH, metadata=metadata)


def check_suffix(path: str | Path) -> None:
    """Raise an InputError if the suffix is not .png, the format that can store the alt text."""
    require_suffix(path, (".png",), "a contact sheet")


def _draw_entry(figure: Figure, entry: Entry, left: int, top: int, layout: _Layout) -> None:
    """Draw an entry with its picture's top left corner at (left, top) pixels, and the text below."""
    width, height = figure.get_size_inches() * PIXELS_PER_INCH
    w = layout.picture_width
    h = layout.picture_height
    ax = figure.add_axes((left / width, 1 - (top + h) / height, w / width, h / height))
    ax.imshow(entry.picture, cmap="gray", vmin=0, vmax=255, aspect="auto")
    ax.set_axis_off()
    _write(figure, left, top + h + 5, entry.name, fontsize=11, fontweight="bold")
    _write(figure, left, top + h + 25, caption(entry), fontsize=9, linespacing=1.35)


def _write(figure: Figure, x: float, y: float, text: str, **options: Any) -> None:
    """Write a text whose top left corner is (x, y) pixels from the sheet's."""
    width, height = figure.get_size_inches() * PIXELS_PER_INCH
    figure.text(x / width, 1 - y / height, text, va="top", ha="left", **options)


def _wrap(text: str, width: int, letter_width: int) -> list[str]:
    """Return a text in lines that fit a sheet, for letters of this mean width in pixels."""
    letters = (width - 2 * GAP_WIDTH) // letter_width
    lines = []
    for paragraph in text.split("\n"):
        lines += wrap(paragraph, letters)
    return lines
