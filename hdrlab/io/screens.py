"""Write images for HDR screens: PNG and AVIF with PQ code values, JPEG XL with floats.

In PNG and AVIF, three numbers state what the code values mean: primaries, transfer function and
matrix [ITU-T H.273]. PNG stores them in a chunk cICP [PNG 3rd edition 11.3.2.6], AVIF in a box
nclx. A program that does not know them shows the code values as they are, gray and pale. The JPEG
XL files store linear light instead of code values.
"""

import inspect
import struct
import zlib
from pathlib import Path

import numpy as np

from hdrlab.core import optional
from hdrlab.core.arrays import ArrayLike
from hdrlab.core.optional import imagecodecs
from hdrlab.io import files
from hdrlab.io.own_pictures import PNG_HEADER_BYTES, mark_avif, mark_png

# The numbers of ITU-T H.273: primaries [table 2], transfer function [3] and matrix [4].
COLOR_PRIMARIES = {"bt2020": 9, "p3": 12}
TRANSFER_PQ = 16
MATRIX_IDENTITY = 0
AVIF_MATRIX = {"bt2020": 9, "p3": 6}
FULL_RANGE = 1
MAX_PNG_CODE = 2**16 - 1
AVIF_BITS = 10
MAX_AVIF_CODE = 2**AVIF_BITS - 1
# The error is half a code value in the mean and 1.5 at most; it is twice as large for 99.
AVIF_QUALITY = 100
AVIF_SPEED = 6
AVIF_PIXEL_FORMAT_444 = 1


def write_png(path: str | Path, v: ArrayLike, *, primaries: str = "bt2020") -> None:
    r"""Write a PQ signal as PNG of 16 bits with a chunk cICP, completely or not at all.

    Parameters
    ----------
    path : a .png file; what it held is replaced
    v : (H, W, 3) signal of the channels of these primaries, 0 to 1
    primaries : {"bt2020", "p3"}, ITU-R BT.2020 or Display P3

    Raises
    ------
    ValueError
        For another suffix.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "dusk.png"
    >>> write_png(file, np.full((4, 6, 3), 0.58))
    >>> file.read_bytes()[37:45]
    b'cICP\t\x10\x00\x01'
    """
    files.require_suffix(path, (".png",), "a picture of this kind")
    body = bytes((COLOR_PRIMARIES[primaries], TRANSFER_PQ, MATRIX_IDENTITY, FULL_RANGE))
    named_body = b"cICP" + body
    checksum = zlib.crc32(named_body)
    chunk = struct.pack(">L", len(body)) + named_body + struct.pack(">L", checksum)
    codes = np.rint(MAX_PNG_CODE * np.asarray(v)).astype(np.uint16, order="C")
    data = mark_png(imagecodecs.png_encode(codes))
    files.write(path, data[:PNG_HEADER_BYTES] + chunk + data[PNG_HEADER_BYTES:])


def write_avif(path: str | Path, v: ArrayLike, *, primaries: str = "bt2020") -> None:
    """Write a PQ signal as AVIF of 10 bits with a box nclx, completely or not at all.

    Parameters
    ----------
    path : an .avif file; what it held is replaced
    v : (H, W, 3) signal of the channels of these primaries, 0 to 1
    primaries : {"bt2020", "p3"}, ITU-R BT.2020 or Display P3

    Raises
    ------
    ValueError
        For another suffix.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "dusk.avif"
    >>> write_avif(file, np.full((4, 6, 3), 0.58))
    >>> b"nclx" in file.read_bytes()
    True
    """
    files.require_suffix(path, (".avif",), "a picture of this kind")
    _require_colors_of_avif()
    codes = np.rint(MAX_AVIF_CODE * np.asarray(v)).astype(np.uint16, order="C")
    data = imagecodecs.avif_encode(
        codes,
        AVIF_QUALITY,
        bitspersample=AVIF_BITS,
        speed=AVIF_SPEED,
        primaries=COLOR_PRIMARIES[primaries],
        transfer=TRANSFER_PQ,
        matrix=AVIF_MATRIX[primaries],
        pixelformat=AVIF_PIXEL_FORMAT_444,
    )
    files.write(path, mark_avif(data))


def _require_colors_of_avif() -> None:
    """Raise MissingPackageError if imagecodecs cannot state the primaries of an AVIF."""
    if "primaries" not in inspect.signature(imagecodecs.avif_encode).parameters:
        raise optional.MissingPackageError(
            "writing AVIF needs imagecodecs 2025.11.11 or later, "
            f"this is {imagecodecs.__version__}; run pip install --upgrade imagecodecs",
            name="imagecodecs",
        )


def write_jxl(path: str | Path, E: ArrayLike) -> None:
    """Write linear light as lossless JPEG XL of 32-bit floats, completely or not at all.

    Parameters
    ----------
    path : a .jxl file; what it held is replaced
    E : (H, W, 3) light with the primaries of sRGB, 1 = white

    Raises
    ------
    ValueError
        For another suffix.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "dusk.jxl"
    >>> write_jxl(file, np.full((4, 6, 3), 2.5))
    >>> float(imagecodecs.jpegxl_decode(file.read_bytes()).max())
    2.5
    """
    files.require_suffix(path, (".jxl",), "a picture of this kind")
    files.write(
        path, imagecodecs.jpegxl_encode(np.asarray(E, np.float32, order="C"), lossless=True)
    )
