"""Radiance files by their suffix: .hdr, .pic and .rad are Radiance RGBE, .pfm float maps, .exr OpenEXR."""

from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core.arrays import as_radiance
from hdrlab.io import exr, pfm, rgbe

SUFFIXES: dict[str, ModuleType] = {".hdr": rgbe, ".pic": rgbe, ".rad": rgbe, ".pfm": pfm, ".exr": exr}


def read_radiance(path: str | Path, *, clean: bool = False) -> NDArray[np.float32]:
    """Read a radiance map, in the format that the file's suffix names.

    Parameters
    ----------
    path : a .hdr, .pic, .rad, .pfm or .exr file
    clean : True to mend values that are no radiance: NaN and negative ones become 0, infinite ones the
        largest finite one

    Returns
    -------
    E : (H, W, 3) or (H, W) float32, finite and not negative

    Raises
    ------
    ValueError
        For another suffix, a file that is damaged or not of its format, and, unless `clean`, values that
        are no radiance; the message counts them.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "ramp.pfm"
    >>> write_radiance(path, [[0.5, 1.0, 2.0]])
    >>> read_radiance(path)
    array([[0.5, 1. , 2. ]], dtype=float32)
    """
    E = format_of(path).read(path)
    if clean:
        return mend(E)
    try:
        return as_radiance(E)
    except ValueError as error:
        raise ValueError(f"{path}: {error}; clean=True (--clean) mends them") from None


def write_radiance(path: str | Path, E: ArrayLike, *, half: bool = False) -> None:
    """Write a radiance map, in the format that the file's suffix names, whole or not at all.

    Parameters
    ----------
    path : a .hdr, .pic, .rad, .pfm or .exr file; what it held is replaced
    E : (H, W, 3) or (H, W) radiance, finite and not negative
    half : True for 16-bit floats, in .exr alone

    Raises
    ------
    ValueError
        For another suffix, and for values that are no radiance or that the format cannot hold.
    """
    form = format_of(path)
    if half and form is not exr:
        raise ValueError(f"{path}: expected an .exr file for half floats, got {Path(path).suffix}")
    if form is exr:
        exr.write(path, E, half=half)
    else:
        form.write(path, E)


def format_of(path: str | Path) -> ModuleType:
    """Return the module that reads and writes files of this suffix, or raise a ValueError."""
    suffix = Path(path).suffix.lower()
    if suffix not in SUFFIXES:
        raise ValueError(
            f"{path}: expected a radiance file ({', '.join(SUFFIXES)}), got {suffix or 'no suffix'}"
        )
    return SUFFIXES[suffix]


def mend(E: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return E with NaN and negative values replaced by 0, and infinite ones by the largest finite one."""
    finite = E[np.isfinite(E)]
    largest = max(float(finite.max()), 0.0) if finite.size else 0.0
    mended: NDArray[np.float32] = np.clip(np.nan_to_num(E, nan=0.0, posinf=largest, neginf=0.0), 0, None)
    return mended
