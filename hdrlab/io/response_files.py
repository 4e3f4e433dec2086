"""Read and write response curves: tables (.csv), and the files of pfstools (.m).

g  response  (n,) or (n, 3), ln exposure of each pixel value z, g[n // 2] = 0
f  f^-1      exp g, the exposure of each pixel value, in any unit

.csv  One line per pixel value: z, then g of red, green and blue, or of gray, as the header states.
      It keeps every bit.
.m    One block in Octave's text format per channel (IR, IG and IB, or IY for gray), with log10 f,
      z and f on each line, and a block W of weights, without which pfstools refuses the file. It
      keeps 10 digits.
"""

import re
from pathlib import Path
from typing import TextIO

import numpy as np

from hdrlab.core.arrays import F64, MAX_LN_EXPOSURE, ArrayLike, describe
from hdrlab.core.weights import gaussian
from hdrlab.errors import InputError
from hdrlab.io.files import replacing, require_no_folder, require_suffix

# Three channels of 65536 pixel values take 10 million bytes.
MAX_FILE_BYTES = 32 * 2**20
# The names of the columns and of pfstools' matrices, by the number of channels.
COLUMN_NAMES = {1: ("gray",), 3: ("red", "green", "blue")}
MATRIX_NAMES = {1: ("IY",), 3: ("IR", "IG", "IB")}
COLUMN_UNIT = " (ln exposure)"
MATRIX_HEADER = re.compile(
    r"^# name: *(\w+) *\n# type: *matrix *\n# rows: *(\d{1,6}) *\n# columns: *3 *\n", re.M
)
DECIMAL_NUMBER = re.compile(
    r"\s*[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d{1,3})?\s*", re.ASCII | re.IGNORECASE
)


def write_curve(path: str | Path, g: ArrayLike) -> None:
    """Write a response in the format that the file's suffix names, completely or not at all.

    Parameters
    ----------
    path : a .csv or .m file; an existing one is replaced
    g : (n,) or (n, 3) float, n = 256 or 65536, ln exposure of each pixel value

    Raises
    ------
    InputError
        For another suffix, and for a response that is not finite or has another shape.

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
        g, ln exposure of each pixel value, shifted to 0 at n // 2 in every channel, because
        pfstools does not normalize the channels. Pixel values with no exposure, where pfstools
        found nothing, are interpolated from their neighbors.

    Raises
    ------
    InputError
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
    """Return the suffix that names a file's format, or raise an InputError."""
    return require_suffix(path, FORMS, "a response curve")


def as_curve(g: ArrayLike) -> F64:
    """Return g as float64 (n,) or (n, 3), n = 256 or 65536, or raise an InputError.

    The values must be finite, and exp g must fit into float32.
    """
    curve = np.asarray(g)
    is_number = curve.dtype.kind in "iuf"
    is_table = curve.ndim in (1, 2) and curve.shape[1:] in ((), (3,))
    if not is_number or not is_table:
        raise InputError(f"expected a response (n,) or (n, 3), got {describe(curve)}")
    if len(curve) not in (256, 65536):
        raise InputError(f"expected 256 or 65536 levels, got {len(curve)}; it may be cut short")
    is_within_limits = np.abs(curve) <= MAX_LN_EXPOSURE  # False for NaN
    if not np.all(is_within_limits):
        limits = f"-{MAX_LN_EXPOSURE} to {MAX_LN_EXPOSURE}"
        raise InputError(f"expected ln exposures from {limits}, got {describe(curve)}")
    return curve.astype(np.float64)


def _write_csv(path: Path, g: F64) -> None:
    """Write g with all its digits."""
    columns = g.reshape(len(g), -1)
    names = COLUMN_NAMES[columns.shape[1]]
    lines = [",".join(["level", *(name + COLUMN_UNIT for name in names)])]
    for z, row in enumerate(columns.tolist()):
        lines.append(",".join([str(z), *map(repr, row)]))
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def _read_csv(path: Path) -> F64:
    """Return g of a .csv file, or raise an InputError."""
    header, _, body = path.read_text(encoding="latin-1").partition("\n")
    names = [name.strip().removesuffix(COLUMN_UNIT) for name in header.split(",")]
    has_columns = names[0] == "level" and tuple(names[1:]) in COLUMN_NAMES.values()
    if not has_columns or COLUMN_UNIT not in header:
        raise InputError(
            f"expected the columns level, red, green and blue{COLUMN_UNIT}, got {header[:80]!r}"
        )
    table = parse_table(body, len(names), ",")
    if not np.array_equal(table[:, 0], np.arange(len(table))):
        raise InputError(
            f"expected one level per line, starting with 0, got {table[:4, 0].tolist()} ..."
        )
    return squeeze_gray(table[:, 1:])


def _write_pfstools(path: Path, g: F64) -> None:
    """Write g as pfstools does, with 10 digits."""
    columns = g.reshape(len(g), -1)
    z = np.arange(len(g))
    with open(path, "w", encoding="ascii") as file:
        for name, channel in zip(MATRIX_NAMES[columns.shape[1]], columns.T, strict=True):
            comment = f"Camera response curve, channel {name}\n"
            comment += "data layout: log10(response) | camera output | response"
            table = np.column_stack([channel / np.log(10), z, np.exp(channel)])
            _write_matrix(file, comment, name, table)
        comment = "Weighting function\ndata layout: weight | camera output"
        table = np.column_stack([gaussian(len(g)), z])
        _write_matrix(file, comment, "W", table)


def _write_matrix(file: TextIO, comment: str, name: str, table: F64) -> None:
    """Write a matrix in Octave's text format; pfstools needs the numbers of rows and columns."""
    rows, columns = table.shape
    header = f"{comment}\nname: {name}\ntype: matrix\nrows: {rows}\ncolumns: {columns}"
    np.savetxt(file, table, [" %.9e", "%4d", "%.9e"][:columns], header=header)
    file.write("\n")


def _read_pfstools(path: Path) -> F64:
    """Return ln f of a file of pfstools, or raise an InputError."""
    text = path.read_text(encoding="latin-1").replace("\r\n", "\n")
    headers = list(MATRIX_HEADER.finditer(text))
    names = tuple(header[1] for header in headers)
    row_counts = {int(header[2]) for header in headers}
    if names not in MATRIX_NAMES.values() or len(row_counts) != 1:
        got = ", ".join(f"{header[1]} of {header[2]} levels" for header in headers[:4]) or "none"
        raise InputError(
            f"expected a response of pfstools: channels IR, IG and IB, or IY; got {got}"
        )
    (rows,) = row_counts
    f = [_read_matrix(text[header.end() :], rows) for header in headers]
    return squeeze_gray(ln_exposure(np.stack(f, axis=-1)))


def _read_matrix(text: str, rows: int) -> F64:
    """Return f (rows,) of the matrix whose lines begin the text."""
    *lines, _ = text.split("\n", rows)
    table = parse_table("\n".join([*lines, ""]), 3)
    if not np.array_equal(table[:, 1], np.arange(rows)):
        raise InputError(
            f"expected the levels 0 to {rows - 1}, got {len(table)} lines; it may be cut short"
        )
    return table[:, 2]


def squeeze_gray(columns: F64) -> F64:
    """Return (n, channels) as (n,) where there is one channel."""
    return columns[:, 0] if columns.shape[1] == 1 else columns


def ln_exposure(f: F64) -> F64:
    """Return ln f (n, channels), interpolated linearly where f is 0.

    Examples
    --------
    >>> ln_exposure(np.array([[1.0], [0.0], [4.0]])).round(3).ravel().tolist()
    [0.0, 0.693, 1.386]
    """
    if np.any(f < 0) or not np.all(np.any(f > 0, axis=0)):
        raise InputError(
            f"expected exposures that are not negative and not all zero, got {describe(f)}"
        )
    z = np.arange(len(f))
    filled = []
    for channel in f.T:
        is_known = channel > 0
        filled.append(np.interp(z, z[is_known], np.log(channel[is_known])))
    return np.stack(filled, axis=-1)


def parse_table(text: str, columns: int, separator: str | None = None) -> F64:
    """Return the numbers of a text (lines, columns), or raise an InputError that names the line.

    The last line must have an end: without one, its last number may have been cut short.
    """
    if not text.endswith("\n"):
        raise InputError("its last line is incomplete; it may be cut short")
    rows = [line.split(separator) for line in text.splitlines()]
    for count, row in enumerate(rows, 1):
        if len(row) != columns or not all(map(DECIMAL_NUMBER.fullmatch, row)):
            got = (separator or " ").join(row)[:60]
            raise InputError(
                f"expected {columns} numbers in line {count} of its table, got {got!r}"
            )
    return np.array(rows, np.float64).reshape(-1, columns)


# The functions that write and read a file, by its suffix.
FORMS = {".csv": (_write_csv, _read_csv), ".m": (_write_pfstools, _read_pfstools)}
