"""Pictures for screens that are brighter than white: PNG and AVIF of PQ's codes, JPEG XL of floats.

A PNG or an AVIF says by three numbers what its codes mean: primaries, curve and matrix [ITU-T H.273]. The PNG
says it in a chunk cICP [PNG 3rd edition 11.3.2.6], the AVIF in a box nclx. A program that does not know them
shows the codes as they are, gray and pale. A JPEG XL here holds no codes but the light itself.
"""

import struct
import zlib
from pathlib import Path

import numpy as np

from hdrlab.core.optional import imagecodecs
from hdrlab.core.types import ArrayLike
from hdrlab.io import files

# primaries, and the matrix from them to what an AVIF holds [H.273 tables 2 and 4]; PQ is a curve [table 3]
PRIMARIES, PQ = {"bt2020": (9, 9), "p3": (12, 6)}, 16
HEADER = 33  # bytes of a PNG before its second chunk
QUALITY = 100  # of AVIF: off by half a code in the mean, by a code and a half at most; 99 by twice as much


def write(path: str | Path, kind: str, values: ArrayLike, *, primaries: str = "bt2020") -> None:
    r"""Write a picture as PNG of 16 bits, as AVIF of 10, or as JPEG XL of 32-bit floats, whole or not at all.

    Parameters
    ----------
    path : the file, whose suffix is its kind; what it held is replaced
    kind : {"png", "avif", "jxl"}
    values : (H, W, 3) PQ's signal of the channels of these primaries, 0 to 1; of a JPEG XL, which is without
        loss, light of the primaries of sRGB, 1 = white
    primaries : {"bt2020", "p3"}, ITU-R BT.2020 or Display P3

    Raises
    ------
    ValueError
        For another suffix.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "dusk.png"
    >>> write(file, "png", np.full((4, 6, 3), 0.58))
    >>> file.read_bytes()[37:45]
    b'cICP\t\x10\x00\x01'
    """
    files.require_suffix(path, (f".{kind}",), "a picture of this kind")
    colour, matrix = PRIMARIES[primaries]
    codes = np.rint(np.asarray(values) * {"png": 65535, "avif": 1023}.get(kind, 0)).astype(np.uint16)
    if kind == "jxl":
        data = imagecodecs.jpegxl_encode(np.asarray(values, np.float32), lossless=True)
    elif kind == "avif":
        said = {"primaries": colour, "transfer": PQ, "matrix": matrix, "pixelformat": 1}  # 4:4:4
        data = imagecodecs.avif_encode(codes, QUALITY, bitspersample=10, speed=6, **said)
    else:
        data, chunk = imagecodecs.png_encode(codes), b"cICP" + bytes((colour, PQ, 0, 1))
        chunk = struct.pack(">L", 4) + chunk + struct.pack(">L", zlib.crc32(chunk))
        data = data[:HEADER] + chunk + data[HEADER:]
    files.write(path, data)
