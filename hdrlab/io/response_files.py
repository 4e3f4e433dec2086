"""Response curves by their suffix: tables of our own, and the files of pfstools.

g  response  (n,) or (n, 3), ln exposure of each pixel level, g[n // 2] = 0
f  f^-1      exp g, the exposure of each level, in any unit

.csv  a line per level: the level, then g of red, green and blue, or of gray; the header says so
.m    pfstools: a block of Octave's text format per channel (IR, IG, IB; IY for gray), each line log10 f,
      level, f; and a block W of weights, without which it refuses the file

The first keeps every bit, the second 10 digits.
"""

import re
from pathlib import Path
from typing import TextIO

import numpy as np

from hdrlab.core.arrays import F64, MAX_LN_EXPOSURE, ArrayLike, describe
from hdrlab.core.weights import gaussian
from hdrlab.errors import InputError
from hdrlab.io.files import replacing, require_no_folder, require_suffix

# three channels of 65536 levels take 10 million
MAX_FILE_BYTES = 32 << 20
CHANNELS = {1: ("gray",), 3: ("red", "green", "blue")}
UNIT = " (ln exposure)"
MATRICES = {1: ("IY",), 3: ("IR", "IG", "IB")}  # the names pfstools gives to the channels
BLOCK = re.compile(
    r"^# name: *(\w+) *\n# type: *matrix *\n# rows: *(\d{1,6}) *\n# columns: *3 *\n", re.M
)
NUMBER = re.compile(r"\s*[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d{1,3})?\s*", re.ASCII | re.IGNORECASE)


def write_curve(path: str | Path, g: ArrayLike) -> None:
    """Write a response in the format that the file's suffix names, whole or not at all.

    Parameters
    ----------
    path : a .csv or .m file; what it held is replaced
    g : (n,) or (n, 3) float, n = 256 or 65536, ln exposure of each level

    Raises
    ------
    ValueError
        For another suffix, and for what is no response: not finite, or of another shape.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "gamma.csv"
    >>> write_curve(path, 2.2 * np.log(np.maximum(np.arange(256), 1) / 128))
    >>> read_curve(path)[[64, 128]].round(3)
    array([-1.525,  0.   ])
    """
    write, _ = FORMS[suffix_of(path)]
    g = as_curve(g)
    with replacing(path) as temporary:
        write(temporary, g)


def read_curve(path: str | Path) -> F64:
    """Read a response, in the format that the file's suffix names.

    Parameters
    ----------
    path : a .csv or .m file

    Returns
    -------
    (n,) or (n, 3) float64
        g, ln exposure of each level, 0 at level n // 2 in every channel: pfstools leaves the
        channels in other proportions. Levels of no exposure, where it found nothing, are filled
        from their neighbours.

    Raises
    ------
    ValueError
        For another suffix, and for a file that is damaged, cut short or not of its format.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "linear.m"
    >>> write_curve(path, np.log(np.arange(1, 257) / 129))
    >>> read_curve(path)[[0, 128, 255]].round(3)
    array([-4.86 ,  0.   ,  0.685])
    """
    _, read = FORMS[suffix_of(path)]
    require_no_folder(path, "a response curve")
    size = Path(path).stat().st_size
    if size > MAX_FILE_BYTES:
        raise InputError(
            f"{path}: expected a response of at most {MAX_FILE_BYTES} bytes, got {size}"
        )
    try:
        g = as_curve(read(Path(path)))
    except ValueError as error:
        raise InputError(f"{path}: {error}") from None
    return g - g[len(g) // 2]


def suffix_of(path: str | Path) -> str:
    """Return the suffix that names a file's format, or raise a ValueError."""
    return require_suffix(path, FORMS, "a response curve")


def as_curve(g: ArrayLike) -> F64:
    """Return g as float64 (n,) or (n, 3), n = 256 or 65536, within float32, or raise a ValueError."""
    curve = np.asarray(g)
    if (
        curve.dtype.kind not in "iuf"
        or curve.ndim not in (1, 2)
        or curve.shape[1:] not in ((), (3,))
    ):
        raise InputError(f"expected a response (n,) or (n, 3), got {describe(curve)}")
    if len(curve) not in (256, 65536):
        raise InputError(f"expected 256 or 65536 levels, got {len(curve)}: is it cut short?")
    if not np.all(np.abs(curve) <= MAX_LN_EXPOSURE):  # NaN neither
        limits = f"-{MAX_LN_EXPOSURE} to {MAX_LN_EXPOSURE}"
        raise InputError(f"expected ln exposures from {limits}, got {describe(curve)}")
    return curve.astype(np.float64)


def _write_csv(path: Path, g: F64) -> None:
    columns = g.reshape(len(g), -1)
    header = ",".join(["level", *(name + UNIT for name in CHANNELS[columns.shape[1]])])
    lines = [",".join([str(z), *map(repr, row)]) for z, row in enumerate(columns.tolist())]
    path.write_text("\n".join([header, *lines, ""]), encoding="ascii")


def _read_csv(path: Path) -> F64:
    header, _, body = path.read_text(encoding="latin-1").partition("\n")
    names = [name.strip().removesuffix(UNIT) for name in header.split(",")]
    if tuple(names[1:]) not in CHANNELS.values() or names[0] != "level" or UNIT not in header:
        raise InputError(
            f"expected the columns level, red, green and blue{UNIT}, got {header[:80]!r}"
        )
    table = numbers(body, len(names), ",")
    if not np.array_equal(table[:, 0], np.arange(len(table))):
        raise InputError(
            f"expected the levels from 0 on, one a line, got {table[:4, 0].tolist()} ..."
        )
    return squeeze_gray(table[:, 1:])


def _write_pfstools(path: Path, g: F64) -> None:
    """Write g as pfstools does, with 10 digits."""
    columns, z = g.reshape(len(g), -1), np.arange(len(g))
    about = (
        "Camera response curve, channel {}\ndata layout: log10(response) | camera output | response"
    )
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


def _read_pfstools(path: Path) -> F64:
    """Return ln f of a file of pfstools, or raise a ValueError."""
    text = path.read_text(encoding="latin-1").replace("\r\n", "\n")
    heads = list(BLOCK.finditer(text))
    rows = {int(head[2]) for head in heads}
    if tuple(head[1] for head in heads) not in MATRICES.values() or len(rows) != 1:
        got = ", ".join(f"{head[1]} of {head[2]} levels" for head in heads[:4]) or "none"
        raise InputError(
            f"expected a response of pfstools: channels IR, IG and IB, or IY; got {got}"
        )
    f = [_read_block(text[head.end() :], *rows) for head in heads]
    return squeeze_gray(ln_exposure(np.stack(f, axis=-1)))


def _read_block(text: str, rows: int) -> F64:
    """Return f (rows,) of the block whose lines begin the text."""
    *lines, _ = text.split("\n", rows)
    table = numbers("\n".join([*lines, ""]), 3)
    if not np.array_equal(table[:, 1], np.arange(rows)):
        raise InputError(
            f"expected the levels 0 to {rows - 1}, got {len(table)} lines: is it cut short?"
        )
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
        raise InputError(
            f"expected exposures that are not negative, and not all zero, got {describe(f)}"
        )
    level = np.arange(len(f))
    filled = [np.interp(level, level[one > 0], np.log(one[one > 0])) for one in f.T]
    return np.stack(filled, axis=-1)


def numbers(text: str, columns: int, separator: str | None = None) -> F64:
    """Return the numbers of a text (lines, columns), or raise a ValueError that names the line.

    The last line must end too: a number that was cut short is a number still.
    """
    if not text.endswith("\n"):
        raise InputError("expected a table whose last line ends: is it cut short?")
    rows = [line.split(separator) for line in text.splitlines()]
    for count, row in enumerate(rows, 1):
        if len(row) != columns or not all(map(NUMBER.fullmatch, row)):
            got = (separator or " ").join(row)[:60]
            raise InputError(
                f"expected {columns} numbers in line {count} of its table, got {got!r}"
            )
    return np.array(rows, np.float64).reshape(-1, columns)


# how each is written and read, by its suffix
FORMS = {".csv": (_write_csv, _read_csv), ".m": (_write_pfstools, _read_pfstools)}
