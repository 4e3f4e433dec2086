"""Portable float maps, .pfm: text lines for the kind, the size and the scale, then float32 values.

PF is RGB and Pf is gray. A negative scale means little endian. Rows run from the bottom to the top.
The scale's magnitude is not applied, because the format never settled whether to multiply or to
divide by it. Header lines end in LF; a file with CR LF is read if its length fits.
"""

import os
import re
import sys
from io import FileIO
from math import prod
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from hdrlab.core.arrays import F32, Array, ArrayLike, as_radiance
from hdrlab.errors import FileFormatError
from hdrlab.io.files import check_size, replacing, reserve

# Exactly one white space follows the scale, because the first byte of the values may look like one.
HEADER = re.compile(rb"(PF|Pf)\s+(\d{1,10})\s+(\d{1,10})\s+([-+]?\d*\.?\d*(?:[eE][-+]?\d{1,3})?)\s")
# Rows that are written at a time: they stay in the cache, which is four times as fast as one write.
BAND_ROWS = 16
# Rows that one system call reads; Linux allows 1024 buffers.
MAX_ROWS_PER_READ = 512


def from_bytes(data: bytes) -> F32:
    """Return the values (H, W[, 3]) of a PFM file, given as bytes."""
    match = HEADER.match(data)
    if not match:
        raise FileFormatError("expected a PFM file: PF or Pf, width, height and scale")
    kind, width, height, scale = match.groups()
    shape = (int(height), int(width), 3)[: 3 if kind == b"PF" else 2]
    order = "<f4" if float(scale) < 0 else ">f4"
    E = np.frombuffer(data, order, prod(shape), match.end()).reshape(shape)
    return E[::-1].astype(np.float32)


def to_bytes(E: ArrayLike) -> bytes:
    r"""Return the PFM file of radiance (H, W[, 3]), as bytes.

    Examples
    --------
    >>> to_bytes([[0.0], [1.0]])  # the lower row first
    b'Pf\n1 2\n-1.0\n\x00\x00\x80?\x00\x00\x00\x00'
    """
    E = np.asarray(E)
    return header_of(E) + E[::-1].astype("<f4").tobytes()


def header_of(E: Array) -> bytes:
    """Return the three lines before the values: kind, width and height, and the byte order."""
    return f"{'PF' if E.ndim == 3 else 'Pf'}\n{E.shape[1]} {E.shape[0]}\n-1.0\n".encode()


class Header(NamedTuple):
    """What a PFM file states before its values; `start` is the offset of the values in bytes."""

    height: int
    width: int
    colour: bool
    scale: float
    start: int


def read_header(path: str | Path) -> Header:
    """Return the header of a PFM file.

    Raises
    ------
    FileFormatError
        For a file that is no PFM file, is shorter than its header claims, or was copied as text.
    """
    with open(path, "rb") as file:
        head = file.read(256)
    match = HEADER.match(head)
    scale = float(match[4]) if match and match[4].strip(b"+-.eE") else 0.0
    if not match or scale == 0 or not np.isfinite(scale):
        raise FileFormatError(
            f"{path}: expected a PFM file (PF or Pf, width, height, scale), got {head[:16]!r}"
        )
    height = int(match[3])
    width = int(match[2])
    is_color = match[1] == b"PF"
    size = height * width * (12 if is_color else 4)
    check_size(path, height, width, size + match.end())
    start = match.end()
    if head[start - 1 : start + 1] == b"\r\n":
        start = _find_start_after_cr_lf(path, start, size)
    return Header(height, width, is_color, scale, start)


def _find_start_after_cr_lf(path: str | Path, after_cr: int, size: int) -> int:
    """Return where the values start behind CR and LF: the LF ends the header, or is in a value.

    The length of the file decides. If neither fits, a program has replaced each LF by CR LF, in the
    values, too.
    """
    file_size = os.path.getsize(path)
    for start in (after_cr + 1, after_cr):
        if file_size == start + size:
            return start
    raise FileFormatError(
        f"{path}: its line ends are CR LF and its length does not fit, so a program copied it as "
        "text; copy the original again, as a binary file"
    )


def read(path: str | Path, *, flip: bool = True) -> F32:
    """Read a PFM file, with the values as they stand in it.

    Parameters
    ----------
    path : the file
    flip : False for a file whose rows run from the top to the bottom, as some programs write them

    Returns
    -------
    (H, W, 3) or (H, W) float32, the first row at the top.

    Raises
    ------
    ValueError
        For a file that is not one, or is cut short.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "rows.pfm"
    >>> write(file, [[1.0], [2.0]])
    >>> read(file).tolist(), read(file, flip=False).tolist()
    ([[1.0], [2.0]], [[2.0], [1.0]])
    """
    header = read_header(path)
    shape = (header.height, header.width, 3) if header.colour else (header.height, header.width)
    E = np.empty(shape, np.float32)
    rows = list(E[::-1] if flip else E)
    bytes_read = 0
    with open(path, "rb", buffering=0) as file:
        file.seek(header.start)
        for y in range(0, len(rows), MAX_ROWS_PER_READ):
            bytes_read += _read_rows(file, rows[y : y + MAX_ROWS_PER_READ])
    if bytes_read < E.nbytes:
        raise FileFormatError(
            f"{path}: expected {E.nbytes} bytes of values, but the file became shorter while it was read"
        )
    is_little_endian = header.scale < 0
    if is_little_endian != (sys.byteorder == "little"):
        E.byteswap(inplace=True)
    return E


def _read_rows(file: FileIO, rows: list[Any]) -> int:
    """Read the next bytes of a file into the rows, each in its place, and return their number."""
    if hasattr(os, "readv"):  # not on Windows
        return os.readv(file.fileno(), rows)
    return sum(file.readinto(row) for row in rows)


def write(path: str | Path, E: ArrayLike, *, flip: bool = True) -> None:
    """Write radiance as a little-endian PFM file of scale -1.0, completely or not at all.

    Parameters
    ----------
    path : the file; what it held is replaced
    E : (H, W) or (H, W, 3) radiance, finite and not negative
    flip : False to write the rows from the top to the bottom, which breaks the format

    Raises
    ------
    ValueError
        For NaN, infinite or negative values.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "light.pfm"
    >>> write(file, [[0.25, 1e6]])
    >>> read(file).tolist()
    [[0.25, 1000000.0]]
    """
    E = as_radiance(E)
    header = header_of(E)
    rows = E[::-1] if flip else E
    with replacing(path) as name, open(name, "wb") as file:
        reserve(file, len(header) + E.nbytes)
        file.write(header)
        for y in range(0, len(rows), BAND_ROWS):
            file.write(np.ascontiguousarray(rows[y : y + BAND_ROWS], dtype="<f4").data)
