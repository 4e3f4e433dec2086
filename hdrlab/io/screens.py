"""Pictures for screens that are brighter than white: PNG and AVIF of PQ's codes, JPEG XL of floats.

A PNG or an AVIF says by three numbers what its codes mean: primaries, curve and matrix [ITU-T
H.273]. The PNG says it in a chunk cICP [PNG 3rd edition 11.3.2.6], the AVIF in a box nclx. A
program that does not know them shows the codes as they are, gray and pale. A JPEG XL here holds no
codes but the light itself.
"""

import struct
import zlib
from pathlib import Path

import numpy as np

from hdrlab.core.arrays import ArrayLike
from hdrlab.core.optional import imagecodecs
from hdrlab.io import files

# primaries, and the matrix from them to what an AVIF holds [H.273 tables 2 and 4]; PQ is a curve
# [table 3]
PRIMARIES, PQ = {"bt2020": (9, 9), "p3": (12, 6)}, 16
HEADER = 33  # bytes of a PNG before its second chunk
# of AVIF: off by half a code in the mean, by a code and a half at most; 99 by twice as much
QUALITY = 100


def write_png(path: str | Path, v: ArrayLike, *, primaries: str = "bt2020") -> None:
    r"""Write PQ's signal as PNG of 16 bits with a chunk cICP, whole or not at all.

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
    chunk = b"cICP" + bytes((PRIMARIES[primaries][0], PQ, 0, 1))
    chunk = struct.pack(">L", 4) + chunk + struct.pack(">L", zlib.crc32(chunk))
    data = imagecodecs.png_encode(np.rint(65535 * np.asarray(v)).astype(np.uint16))
    files.write(path, data[:HEADER] + chunk + data[HEADER:])


def write_avif(path: str | Path, v: ArrayLike, *, primaries: str = "bt2020") -> None:
    """Write PQ's signal as AVIF of 10 bits with a box nclx, whole or not at all.

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
    colour, matrix = PRIMARIES[primaries]
    said = {"primaries": colour, "transfer": PQ, "matrix": matrix, "pixelformat": 1}  # 4:4:4
    codes = np.rint(1023 * np.asarray(v)).astype(np.uint16)
    files.write(path, imagecodecs.avif_encode(codes, QUALITY, bitspersample=10, speed=6, **said))


def write_jxl(path: str | Path, E: ArrayLike) -> None:
    """Write light as JPEG XL of 32-bit floats without loss, whole or not at all.

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
    files.write(path, imagecodecs.jpegxl_encode(np.asarray(E, np.float32), lossless=True))
