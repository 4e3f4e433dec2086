"""Response curves in the files of pfstools, and what every text file of curves needs.

f  f^-1      (n, channels), the exposure of each level, in any unit; each channel may have its own
g  response  (n,) or (n, 3), ln f

pfstools writes a block of Octave's text format per channel (IR, IG, IB; IY for gray), each line log10 f,
level, f; and a block W of weights, without which it refuses the file.
"""

import re
from pathlib import Path
from typing import TextIO

import numpy as np

from hdrlab.core.arrays import F64, describe
from hdrlab.core.weights import gaussian

MATRICES = {1: ("IY",), 3: ("IR", "IG", "IB")}  # the names pfstools gives to the channels
BLOCK = re.compile(r"^# name: *(\w+) *\n# type: *matrix *\n# rows: *(\d{1,6}) *\n# columns: *3 *\n", re.M)
NUMBER = re.compile(r"\s*[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d{1,3})?\s*", re.ASCII | re.IGNORECASE)


def write_pfstools(path: Path, g: F64) -> None:
    """Write g as pfstools does, with 10 digits."""
    columns, z = g.reshape(len(g), -1), np.arange(len(g))
    about = "Camera response curve, channel {}\ndata layout: log10(response) | camera output | response"
    with open(path, "w", encoding="ascii") as file:
        for name, one in zip(MATRICES[columns.shape[1]], columns.T, strict=True):
            table = np.column_stack([one / np.log(10), z, np.exp(one)])
            _write_block(file, about.format(name), name, table)
        table = np.column_stack([gaussian(len(g)), z])
        _write_block(file, "Weighting function\ndata layout: weight | camera output", "W", table)


def _write_block(file: TextIO, about: str, name: str, table: F64) -> None:
    """Write a block of Octave's text format; pfstools goes by the lines of rows and columns."""
    rows, columns = table.shape
    head = f"{about}\nname: {name}\ntype: matrix\nrows: {rows}\ncolumns: {columns}"
    np.savetxt(file, table, [" %.9e", "%4d", "%.9e"][:columns], header=head)
    file.write("\n")


def read_pfstools(path: Path) -> F64:
    """Return ln f of a file of pfstools, or raise a ValueError."""
    text = path.read_text(encoding="latin-1").replace("\r\n", "\n")
    heads = list(BLOCK.finditer(text))
    rows = {int(head[2]) for head in heads}
    if tuple(head[1] for head in heads) not in MATRICES.values() or len(rows) != 1:
        got = ", ".join(f"{head[1]} of {head[2]} levels" for head in heads[:4]) or "none"
        raise ValueError(f"expected a response of pfstools: channels IR, IG and IB, or IY; got {got}")
    f = [_read_block(text[head.end() :], *rows) for head in heads]
    return squeeze_gray(ln_exposure(np.stack(f, axis=-1)))


def _read_block(text: str, rows: int) -> F64:
    """Return f (rows,) of the block whose lines begin the text."""
    *lines, _ = text.split("\n", rows)
    table = numbers("\n".join([*lines, ""]), 3)
    if not np.array_equal(table[:, 1], np.arange(rows)):
        raise ValueError(f"expected the levels 0 to {rows - 1}, got {len(table)} lines: is it cut short?")
    return table[:, 2]


def squeeze_gray(columns: F64) -> F64:
    """Return (n, channels) as (n,) where there is one channel."""
    return columns[:, 0] if columns.shape[1] == 1 else columns


def ln_exposure(f: F64) -> F64:
    """Return ln f (n, channels), with levels of no exposure on lines between those that have one.

    Examples
    --------
    >>> ln_exposure(np.array([[1.0], [0.0], [4.0]])).round(3).ravel().tolist()
    [0.0, 0.693, 1.386]
    """
    if np.any(f < 0) or not np.all(np.any(f > 0, axis=0)):
        raise ValueError(f"expected exposures that are not negative, and not all zero, got {describe(f)}")
    level = np.arange(len(f))
    filled = [np.interp(level, level[one > 0], np.log(one[one > 0])) for one in f.T]
    return np.stack(filled, axis=-1)


def numbers(text: str, columns: int, separator: str | None = None) -> F64:
    """Return the numbers of a text (lines, columns), or raise a ValueError that names the line.

    The last line must end too: a number that was cut short is a number still.
    """
    if not text.endswith("\n"):
        raise ValueError("expected a table whose last line ends: is it cut short?")
    rows = [line.split(separator) for line in text.splitlines()]
    for count, row in enumerate(rows, 1):
        if len(row) != columns or not all(map(NUMBER.fullmatch, row)):
            got = (separator or " ").join(row)[:60]
            raise ValueError(f"expected {columns} numbers in line {count} of its table, got {got!r}")
    return np.array(rows, np.float64).reshape(-1, columns)
