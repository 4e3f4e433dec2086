"""The header of Radiance files: lines of text, an empty line, and the resolution, such as `-Y 768 +X 512`."""

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F64
from hdrlab.io.files import check_size

RESOLUTION = re.compile(r"([-+])([XY]) +(\d{1,10}) +([-+])([XY]) +(\d{1,10})")


class Header(NamedTuple):
    """What a Radiance file says before its pixels.

    Attributes
    ----------
    height, width : of the picture, upright
    axes : the resolution line's order and signs, such as "-Y+X": rows from the top, each from the left
    exposure : (3,) what the pixels were multiplied by: the product of all EXPOSURE and COLORCORR lines
    lines : the header's lines
    start : where the pixels begin, in bytes
    """

    height: int
    width: int
    axes: str
    exposure: F64
    lines: tuple[str, ...]
    start: int


def read_header(path: str | Path) -> Header:
    """Return the Header of the Radiance file at `path`, or raise a ValueError."""
    with open(path, "rb") as file:
        return parse(path, file.read(1 << 16))


def parse(path: str | Path, head: bytes) -> Header:
    """Return what the lines down to the resolution say, or raise a ValueError that names the file."""
    lines, start = [], 0
    while (end := head.find(b"\n", start)) >= 0:
        line, start = head[start:end].decode("latin-1"), end + 1
        if match := RESOLUTION.fullmatch(line.rstrip("\r")):
            break
        if line.strip():
            lines.append(line.rstrip())
    else:
        match = None
    # the mark need not come first: tools of Radiance put lines of their own before it
    if match is None or not any(line.startswith("#?") for line in lines):
        raise ValueError(f"{path}: expected a Radiance file (#?RADIANCE, -Y 768 +X 512), got {head[:16]!r}")
    if line.endswith("\r"):
        raise ValueError(f"{path}: expected a binary file, its line ends became CR LF: copied as text")
    values = dict(part.split("=", 1) for part in lines if "=" in part)
    if (form := values.get("FORMAT", "32-bit_rle_rgbe").strip()) != "32-bit_rle_rgbe":
        raise ValueError(f"{path}: expected FORMAT=32-bit_rle_rgbe, got {form[:60]!r}")
    sign, axis, first, sign2, axis2, second = match.groups()
    if axis == axis2:
        raise ValueError(f"{path}: expected one X and one Y in the resolution, got {line[:60]!r}")
    height, width = (int(first), int(second))[:: 1 if axis == "Y" else -1]
    check_size(path, height, width)
    return Header(height, width, sign + axis + sign2 + axis2, _exposure(path, lines), tuple(lines), start)


def _exposure(path: str | Path, lines: list[str]) -> F64:
    """Return the product of the EXPOSURE and COLORCORR lines: each tool that changed the pixels adds one."""
    product = np.ones(3)
    for line in lines:
        name, _, value = line.partition("=")
        if name in ("EXPOSURE", "COLORCORR"):
            try:
                product = product * np.array(value.split(), dtype=np.float64)
            except ValueError:
                raise ValueError(f"{path}: expected numbers in its header, got {line[:60]!r}") from None
    if not np.all((product > 1e-30) & (product < 1e30)):
        raise ValueError(f"{path}: expected positive exposures in its header, got {product.tolist()}")
    return product
