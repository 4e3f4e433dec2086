"""Print what the photos of a folder state, bracket by bracket, for `hdrlab info FOLDER`."""

from pathlib import Path

import numpy as np

from hdrlab.errors import InputError
from hdrlab.io import album, decode, splitting
from hdrlab.io.exif_exposure import Exposure
from hdrlab.io.own_pictures import is_own_picture, is_radiance_map
from hdrlab.show import plots

HEADINGS = ("file", "time", "ISO", "f-number", "EV", "size", "camera", "missing")
UNKNOWN = "-"
BASE_ISO = 100.0


def describe_folder(folder: Path) -> list[str]:
    """Return the lines of a table of the photos of a folder, a table for each bracket.

    Files that cannot be read follow, with the reason. The notes of `hdrlab.io.album.select` do not:
    the table shows all photos, also those that `assemble` skips.

    Raises
    ------
    InputError
        For a folder without photos.
    """
    headers = []
    problems = []
    for path in album.list_folder(folder):
        if is_own_picture(path):
            problems.append(f"{path.name}: made by hdrlab")
            continue
        if is_radiance_map(path):
            problems.append(f"{path.name}: a radiance map, not a photo")
            continue
        try:
            headers.append(decode.read_header(path))
        except (InputError, OSError) as error:
            problems.append(f"cannot read {path.name}: {error}")
    lines = []
    brackets = splitting.split_into_brackets(headers) if headers else []
    for number, bracket in enumerate(brackets, 1):
        if len(brackets) > 1:
            lines.append(f"bracket {number} of {len(brackets)}")
        lines += _align_columns([HEADINGS, *map(_describe_photo, bracket)])
    return [*lines, *problems]


def exposure_value(exposure: Exposure) -> float | None:
    """Return the exposure value at ISO 100, log2(N^2 / t) - log2(S / 100), or None if one is unknown.

    Examples
    --------
    >>> exposure_value(Exposure(seconds=1, f_number=1, iso=100))
    0.0
    """
    t = exposure.seconds
    N = exposure.f_number
    S = exposure.iso
    if t is None or N is None or S is None:
        return None
    return float(np.log2(N**2 / t * BASE_ISO / S))


def _describe_photo(header: decode.PhotoHeader) -> tuple[str, ...]:
    """Return the cells of a photo's row."""
    exposure = header.exposure
    value = exposure_value(exposure)
    stated = {
        "time": exposure.seconds,
        "ISO": exposure.iso,
        "f-number": exposure.f_number,
        "camera": header.camera,
    }
    missing = [name for name, content in stated.items() if not content]
    height, width = header.shape[:2]
    return (
        header.path.name,
        UNKNOWN if exposure.seconds is None else plots.seconds(exposure.seconds),
        _format_number(exposure.iso),
        _format_number(exposure.f_number),
        UNKNOWN if value is None else f"{value:.1f}",
        f"{width} x {height}",
        header.camera or UNKNOWN,
        ", ".join(missing),
    )


def _format_number(number: float | None) -> str:
    return UNKNOWN if number is None else f"{number:.4g}"


def _align_columns(rows: list[tuple[str, ...]]) -> list[str]:
    """Return the rows as lines whose columns begin at the same place."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = []
    for row in rows:
        cells = [cell.ljust(width) for cell, width in zip(row, widths, strict=True)]
        lines.append("  ".join(cells).rstrip())
    return lines
