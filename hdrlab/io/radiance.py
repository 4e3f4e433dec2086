"""Read and write radiance maps by suffix: RGBE (.hdr, .pic, .rad), PFM, OpenEXR and TIFF.

A .jpg with a gain map (Ultra HDR) is read as the brightest screen shows it. A .jxl file of floats
is read, too.
"""

import dataclasses
import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import ModuleType

import numpy as np

from hdrlab.core import arrays, gamut
from hdrlab.errors import FileFormatError, InputError
from hdrlab.io import decode
from hdrlab.io.files import require_no_folder, require_suffix
from hdrlab.io.maps import exr, pfm, rgbe, tiff, ultrahdr

SUFFIXES: dict[str, ModuleType] = {
    ".hdr": rgbe,
    ".pic": rgbe,
    ".rad": rgbe,
    ".pfm": pfm,
    ".exr": exr,
    ".tif": tiff,
    ".tiff": tiff,
}
# Below this determinant of their x, y and z, three colors are no primaries: sRGB's have 0.2.
MIN_PRIMARIES_DETERMINANT = 1e-3
# The sentence in the header of a map that states its unit; without a number, it is 1 cd/m^2.
UNIT_SENTENCE = re.compile(r"unit: (?:(\d[-+.\de]{0,30}) )?cd/m\^2")
MAX_UNIT_SENTENCE = re.compile(r"unit: at most (\d[-+.\de]{0,30}) cd/m\^2")
# Ultra HDR files need a picture as well as a radiance map, so `write_radiance` cannot write them.
READ = SUFFIXES | {".jpg": ultrahdr, ".jpeg": ultrahdr, ".jxl": tiff}


def read_radiance(path: str | Path, *, clean: bool = False) -> arrays.F32:
    """Read a radiance map, in the format that the file's suffix names.

    Parameters
    ----------
    path : a .hdr, .pic, .rad, .pfm, .exr, .tif, .tiff or .jxl file, or a .jpg or .jpeg with a gain
        map
    clean : True to repair values that are not radiance, see `core.gamut.sanitize`: NaN takes the
        mean of its neighbors, infinity the largest finite value, and a negative channel makes its
        pixel less colorful

    Returns
    -------
    E : (H, W, 3) or (H, W) float32, finite and not negative, with the primaries of sRGB

    Raises
    ------
    ValueError
        For another suffix, a file that is damaged or not of its format, and, unless `clean`, values
        that are no radiance; the message counts them.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "ramp.pfm"
    >>> write_radiance(path, [[0.5, 1.0, 2.0]])
    >>> read_radiance(path)
    array([[0.5, 1. , 2. ]], dtype=float32)
    """
    return read_sanitized(path).E if clean else read_valid(path)


def read_sanitized(path: str | Path) -> gamut.Sanitized:
    """Return the radiance map as `read_radiance` cleans it, and counts of what it repaired."""
    require_no_folder(path, "a radiance map")
    E = format_of(path, READ).read(path)
    primaries = primaries_of(path)
    if primaries is None:
        return gamut.sanitize(E)
    sanitized = gamut.sanitize(E, weights=gamut.xyz_matrix(primaries)[1])
    return dataclasses.replace(sanitized, E=gamut.to_srgb(sanitized.E, primaries))


def read_valid(path: str | Path) -> arrays.F32:
    """Return the radiance map; raise an InputError that counts the values that are no radiance."""
    require_no_folder(path, "a radiance map")
    E = format_of(path, READ).read(path)
    try:
        E = arrays.as_radiance(E)
    except ValueError as error:
        raise InputError(f"{path}: {error}; clean=True repairs them") from None
    primaries = primaries_of(path)
    return E if primaries is None else gamut.to_srgb(E, primaries)


def primaries_of(path: str | Path) -> tuple[float, ...] | None:
    """Return the primaries and the white of a map, or None if they are those of sRGB.

    OpenEXR and RGBE files can state them, and the color profile of a TIFF. With them, two files of
    one photo in different primaries give the same radiance map. Other files are assumed to have the
    primaries of sRGB, as nearly all do.

    Raises
    ------
    FileFormatError
        For primaries that are none, such as eight zeros.
    """
    form = format_of(path, READ)
    if form is exr:
        header = exr.read_header(path)
        named = header.attributes.get("chromaticities") if header.is_color else None
    elif form is rgbe:
        named = rgbe.read_header(path).primaries
    elif form is tiff:
        named = tiff.find_primaries(path)
    else:
        named = None
    if named is None or np.allclose(named, gamut.SRGB, atol=1e-3):
        return None
    primaries = tuple(map(float, named))
    _require_primaries(path, primaries)
    return primaries


def _require_primaries(path: str | Path, primaries: tuple[float, ...]) -> None:
    """Raise a FileFormatError for x and y that no red, green, blue and white have."""
    xy = np.array(primaries).reshape(4, 2)
    is_possible = bool(np.isfinite(xy).all() and xy[:, 1].all())
    if is_possible:
        xyz = np.column_stack([xy, 1 - xy.sum(axis=1)])
        mixture = np.linalg.det(xyz[:3])
        is_possible = abs(mixture) > MIN_PRIMARIES_DETERMINANT and xy[3, 1] > 0
    if not is_possible:
        values = ", ".join(f"{value:.4g}" for value in primaries)
        raise FileFormatError(
            f"{path}: its header states primaries that no colors have, x and y are {values}; "
            "remove them from the header if the primaries are those of sRGB"
        )


def read_luminance_of_unit(path: str | Path) -> float | None:
    """Return the cd/m^2 of a white surface with E = 1, as a radiance map states it, or None.

    OpenEXR has the attribute `whiteLuminance`. In the comments of the other formats, hdrlab writes
    a sentence such as "unit: 12.5 cd/m^2". PFM has no place for it.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "night.hdr"
    >>> write_radiance(path, [[0.5, 1.0]], luminance_of_unit=0.25)
    >>> read_luminance_of_unit(path)
    0.25
    """
    if format_of(path, READ) is exr:
        stated = exr.read_header(path).attributes.get("whiteLuminance")
        if isinstance(stated, int | float) and 0 < stated < math.inf:
            return float(stated)
    for comment in _read_comments(path):
        match = UNIT_SENTENCE.fullmatch(comment)
        if match:
            return _parse_unit(match[1])
    return None


def read_max_luminance_of_unit(path: str | Path) -> float | None:
    """Return the upper bound of `read_luminance_of_unit` that hdrlab wrote into a map, or None."""
    for comment in _read_comments(path):
        match = MAX_UNIT_SENTENCE.fullmatch(comment)
        if match:
            return _parse_unit(match[1])
    return None


def _read_comments(path: str | Path) -> Sequence[str]:
    """Return the comments in the header of a radiance map, line by line."""
    form = format_of(path, READ)
    if form is exr:
        return str(exr.read_header(path).attributes.get("comments", "")).splitlines()
    if form is rgbe:
        return [line.removeprefix("# ") for line in rgbe.read_header(path).lines]
    if form is tiff:
        return decode.read_header(path, samples="floating").comments
    return ()


def _parse_unit(text: str | None) -> float | None:
    """Return the number of a sentence on the unit, 1 without one, and None if it is not valid."""
    if text is None:
        return 1.0
    try:
        unit = float(text)
    except ValueError:
        return None
    return unit if 0 < unit < math.inf else None


def write_radiance(
    path: str | Path,
    E: arrays.ArrayLike,
    *,
    half: bool = False,
    comments: Sequence[str] = (),
    luminance_of_unit: float | None = None,
    max_luminance_of_unit: float | None = None,
) -> None:
    """Write a radiance map, in the format that the file's suffix names, completely or not at all.

    Parameters
    ----------
    path : a .hdr, .pic, .rad, .pfm, .exr, .tif or .tiff file; an existing one is replaced
    E : (H, W, 3) or (H, W) radiance, finite and not negative
    half : True for 16-bit floats, in .exr only
    comments : sentences for the header of the file; they are dropped for .pfm, whose header has no
        place for them
    luminance_of_unit : cd/m^2 of a white surface with E = 1, if it is known; it is dropped for .pfm
    max_luminance_of_unit : an upper bound of it, if only that is known; it is dropped for .pfm

    Raises
    ------
    ValueError
        For another suffix, and for values that are no radiance or that the format cannot hold.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "sun.exr"
    >>> write_radiance(path, [[1e-3, 1e6]])
    >>> read_radiance(path).tolist()
    [[0.0010000000474974513, 1000000.0]]
    """
    form = require_writable(path, half=half)
    if luminance_of_unit is not None:
        comments = [describe_unit(luminance_of_unit), *comments]
    elif max_luminance_of_unit is not None:
        comments = [f"unit: at most {max_luminance_of_unit:.6g} cd/m^2", *comments]
    if form is pfm:
        pfm.write(path, E)
    elif form is exr:
        exr.write(path, E, half=half, comments=comments, white_luminance=luminance_of_unit)
    else:
        form.write(path, E, comments=comments)


def describe_unit(luminance_of_unit: float) -> str:
    """Return the sentence that states the unit of a map, which `read_luminance_of_unit` finds."""
    if luminance_of_unit == 1:
        return "unit: cd/m^2"
    return f"unit: {luminance_of_unit:.6g} cd/m^2"


def require_writable(path: str | Path, *, half: bool = False) -> ModuleType:
    """Return the module that writes a radiance map under this name, or raise an InputError."""
    form = format_of(path)
    if half and form is not exr:
        raise InputError(f"{path}: expected an .exr file for half floats, got {Path(path).suffix}")
    return form


def format_of(path: str | Path, formats: Mapping[str, ModuleType] = SUFFIXES) -> ModuleType:
    """Return the module that reads or writes files of this suffix, or raise an InputError."""
    return formats[require_suffix(path, formats, "a radiance file")]
