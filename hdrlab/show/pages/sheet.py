"""A sheet of pictures with their figures: drawn from its entries and from nothing else.

Q, S, N  TMQI: overall, structural fidelity, naturalness, see `tonemap.quality`

Pictures are placed by the pixel: one of the sheet's size stands on it as it is.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path
from textwrap import wrap
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hdrlab.core.picture import Statistics
from hdrlab.errors import InputError
from hdrlab.io.files import replacing, require_suffix
from hdrlab.show.pictures import require_alt
from hdrlab.tonemap.quality import Quality

Size = tuple[int, int]  # pixels, width and height
DPI = 100  # dots per inch: a matplotlib inch is a hundred pixels of the sheet
SIDE = 480  # pixels, the longer side of a picture on the sheet
# pixels: least width and height of the text under a picture, and margins
TEXT = 320
CAPTION = 86
GAP = 14
LEGEND = Path(__file__).with_name("sheet_legend.txt")


class Entry(NamedTuple):
    """One picture of the sheet.

    Attributes
    ----------
    name : of the operator
    picture : (H, W) or (H, W, 3) uint8, sRGB
    seconds : what the operator took
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
    >>> found = Quality(0.934, 0.87, 0.81), Statistics(0.001, 0.0464, 128.6, 40.4, 7.36)
    >>> print(caption(Entry("reinhard", np.zeros((1, 1), np.uint8), 0.0342, *found)))
    Q 0.934   S 0.870   N 0.810   34 ms
    black 0.10 %   clipped 4.64 %
    mean 129   contrast 40   entropy 7.36 bits
    """
    Q, S, N = entry.quality
    black, white, mean, contrast, entropy = entry.statistics
    return (
        f"Q {Q:.3f}   S {S:.3f}   N {N:.3f}   {took(entry.seconds)}\n"
        f"black {100 * black:.2f} %   clipped {100 * white:.2f} %\n"
        f"mean {mean:.0f}   contrast {contrast:.0f}   entropy {entropy:.2f} bits"
    )


def took(seconds: float) -> str:
    """Return a time as '34 ms' or '1.2 s'.

    Examples
    --------
    >>> took(0.0342), took(1.234), took(0.0002)
    ('34 ms', '1.2 s', '0.2 ms')
    """
    if seconds >= 0.9995:
        return f"{seconds:.1f} s"
    return f"{1000 * seconds:.0f} ms" if seconds >= 0.00095 else f"{1000 * seconds:.1g} ms"


def alt_text(entries: Sequence[Entry], title: str = "") -> str:
    """Return what the sheet shows, for a reader who cannot see it: every figure on it, best picture first."""
    ranked = sorted(entries, key=lambda entry: -entry.quality.Q)
    lines = [f"{entry.name}: {', '.join(caption(entry).splitlines())}" for entry in ranked]
    of = f" of {title}" if title else ""
    head = f"Contact sheet{of}: one scene through {len(ranked)} tone-mapping operators, best TMQI first. "
    return head + "; ".join(" ".join(line.split()) for line in lines) + "."


def _grid(shape: tuple[int, ...], count: int, columns: int | None) -> tuple[int, Size, Size]:
    """Return pictures in a row, and the pixels of a picture and its cell; a sheet is broad."""
    h, w = shape[:2]
    width, height = (max(1, round(SIDE * length / max(h, w))) for length in (w, h))
    cell = max(width, TEXT) + GAP, height + CAPTION
    if columns is None:
        columns = max(1, round((1.6 * count * cell[1] / cell[0]) ** 0.5))
        columns = -(-count // -(-count // columns))  # as many rows with fewer places left empty
    return min(columns, count), (width, height), cell


def draw(entries: Iterable[Entry], *, title: str = "", columns: int | None = None) -> Figure:
    """Return the sheet of these entries, in their order; its alt text is the label, `figure.get_label()`.

    Parameters
    ----------
    entries : pictures of one size, with their figures
    title : above the sheet, and in its alt text
    columns : pictures in a row; so many that the sheet is broad rather than tall, unless told
    """
    entries = list(entries)
    if not entries:
        raise InputError("expected at least one picture for the sheet, got none")
    if columns is not None and columns < 1:
        raise InputError(f"expected columns >= 1, got {columns}")
    columns, picture, cell = _grid(entries[0].picture.shape, len(entries), columns)
    width = columns * cell[0] + GAP
    head = _broken(title or "Tone mapping", width, 12)
    foot = _broken(LEGEND.read_text("utf8"), width, 7)
    top = 24 + 20 * len(head)
    below = top + -(-len(entries) // columns) * cell[1]
    size = (width / DPI, (below + 16 + 14 * len(foot)) / DPI)
    figure = Figure(figsize=size, dpi=DPI, facecolor="white")
    figure.set_label(alt_text(entries, title))
    _write(figure, GAP, 12, "\n".join(head), fontsize=13, fontweight="bold")
    for i, entry in enumerate(entries):
        _place(figure, entry, GAP + i % columns * cell[0], top + i // columns * cell[1], picture)
    _write(figure, GAP, below, "\n".join(foot), fontsize=8, color="#404040")
    return figure


def write_sheet(path: str | Path, sheet: Figure) -> None:
    """Write a sheet as PNG, whole or not at all, with its alt text inside: the text chunk "Description".

    Raises
    ------
    ValueError
        For another suffix than .png, or a figure without alt text.
    """
    check_suffix(path)
    alt = require_alt(str(sheet.get_label()))
    with replacing(path) as name:
        sheet.savefig(
            name, format="png", dpi=DPI, metadata={"Title": "Contact sheet", "Description": alt}
        )


def check_suffix(path: str | Path) -> None:
    """Raise a ValueError where a sheet cannot be written under this name."""
    require_suffix(path, (".png",), "a sheet, whose alt text travels in it")


def _place(figure: Figure, entry: Entry, left: int, top: int, picture: Size) -> None:
    """Draw an entry with its picture's top left corner at (left, top) pixels, and the text below."""
    width, height = figure.get_size_inches() * DPI
    w, h = picture
    ax = figure.add_axes((left / width, 1 - (top + h) / height, w / width, h / height))
    ax.imshow(entry.picture, cmap="gray", vmin=0, vmax=255, aspect="auto")
    ax.set_axis_off()
    _write(figure, left, top + h + 5, entry.name, fontsize=11, fontweight="bold")
    _write(figure, left, top + h + 25, caption(entry), fontsize=9, linespacing=1.35)


def _write(figure: Figure, x: float, y: float, text: str, **look: Any) -> None:
    """Write with the text's top left corner at (x, y) pixels from the sheet's."""
    width, height = figure.get_size_inches() * DPI
    figure.text(x / width, 1 - y / height, text, va="top", ha="left", **look)


def _broken(text: str, width: int, letter: int) -> list[str]:
    """Return a text in lines that fit a sheet, for letters of this mean width in pixels."""
    return [line for part in text.split("\n") for line in wrap(part, (width - 2 * GAP) // letter)]
