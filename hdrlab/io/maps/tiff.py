"""Read and write TIFF files of floating-point samples (.tif, .tiff), through tifffile.

Samples have 16, 32 or 64 bits; images are gray or RGB; an alpha channel is dropped. JPEG XL files
of floats are read as well. Files of whole numbers are photos, which `io.photos` reads.

A color profile states the primaries of RGB samples. Its curve has to be a straight line, because
other samples are not linear light.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from hdrlab.core import arrays, optional
from hdrlab.errors import FileFormatError
from hdrlab.io import decode, files, profiles, tiff_pages


def read(path: str | Path) -> arrays.F32:
    """Read a TIFF or JPEG XL file of floating-point samples.

    Parameters
    ----------
    path : the file

    Returns
    -------
    (H, W, 3) or (H, W) float32, upright, with the primaries of the file's profile, see
    `find_primaries`

    Raises
    ------
    ValueError
        For a file that is not one, is damaged, or holds whole numbers.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "light.tif"
    >>> write(file, [[0.25, 1e6]])
    >>> read(file).tolist()
    [[0.25, 1000000.0]]
    """
    header = decode.read_header(path, samples="floating")
    E = np.empty(header.shape, header.dtype)
    decode.decode_photo(header, E)
    # What is too large for 32 bits becomes infinite, which `read_radiance` refuses.
    with np.errstate(over="ignore"):
        return E.astype(np.float32, copy=False)


def find_primaries(path: str | Path) -> tuple[float, ...] | None:
    """Return x and y of red, green, blue and white by the profile of a file of floats.

    Returns
    -------
    8 numbers, or None without a profile and for the primaries of sRGB

    Raises
    ------
    FileFormatError
        For a profile with a curve.
    InputError
        For a profile that is damaged or not of RGB.
    """
    header = decode.read_header(path, samples="floating")
    # EXIF's Adobe RGB is about the photo that a camera wrote, not about these floats.
    has_profile = header.icc not in (b"", profiles.ADOBE)
    if header.kind != "TIFF" or len(header.shape) != 3 or not has_profile:
        return None
    primaries = profiles.find_primaries(path, header.icc)
    if not profiles.is_linear(header.icc):
        raise FileFormatError(
            f"{path}: its color profile has a curve, so its floats are not linear light; "
            "export it with a linear profile, or remove the profile if the values are linear"
        )
    return primaries


def write(path: str | Path, E: arrays.ArrayLike, *, comments: Sequence[str] = ()) -> None:
    """Write radiance as a TIFF file of 32-bit floats, whole or not at all.

    Parameters
    ----------
    path : the file; what it held is replaced
    E : (H, W) or (H, W, 3) radiance, finite and not negative
    comments : sentences for its image description

    Raises
    ------
    ValueError
        For NaN, infinite or negative values.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "light.tif"
    >>> write(file, np.full((2, 3, 3), 0.5), comments=["unit: cd/m2"])
    >>> read(file).shape, decode.read_header(file, samples="floating").comments
    ((2, 3, 3), ['unit: cd/m2'])
    """
    E = arrays.as_radiance(E)
    description = "\n".join(comments).encode() or None
    channels = E.shape[2] if E.ndim == 3 else 1
    photometric = tiff_pages.PHOTOMETRIC[channels].lower()
    with files.replacing(path) as name:
        optional.tifffile.imwrite(
            name, E, photometric=photometric, metadata=None, description=description
        )
