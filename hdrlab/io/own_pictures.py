"""Mark the pictures that hdrlab makes from photos, so that it never takes them for photos.

A picture that lies among the photos that it was made of has the size and type of a photo. The mark
is the software's name, where each format has a place for it.
"""

import struct
import warnings
import zlib
from pathlib import Path

from PIL import Image
from PIL.ExifTags import Base

SOFTWARE = "hdrlab"
# bytes of a PNG file up to the end of its first chunk, IHDR
PNG_HEADER_BYTES = 33


def make_exif() -> Image.Exif:
    """Return EXIF that names the software, for a JPEG."""
    exif = Image.Exif()
    exif[Base.Software] = SOFTWARE
    return exif


def mark_png(data: bytes) -> bytes:
    """Return a PNG file with a text chunk that names the software."""
    content = b"tEXt" + b"Software\0" + SOFTWARE.encode("latin-1")
    length = struct.pack(">I", len(content) - len(b"tEXt"))
    checksum = struct.pack(">I", zlib.crc32(content))
    chunk = length + content + checksum
    return data[:PNG_HEADER_BYTES] + chunk + data[PNG_HEADER_BYTES:]


def is_own_picture(path: Path) -> bool:
    """Return whether a PNG, JPEG or TIFF file is a result of hdrlab; False for a file it cannot open."""
    try:
        with warnings.catch_warnings():
            # Pillow warns of odd EXIF, which does not matter here.
            warnings.simplefilter("ignore")
            with Image.open(path) as image:
                named = image.info.get("Software") or image.getexif().get(Base.Software)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        return False
    return named == SOFTWARE
