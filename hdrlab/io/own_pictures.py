"""Mark the pictures that hdrlab makes from photos, so that it never takes them for photos.

A picture that lies among the photos that it was made of has the size and type of a photo. The mark
is the software's name, where each format has a place for it. AVIF has none that the encoder fills,
so the mark is a box of hdrlab's own at the end of the file, which other programs skip.

Radiance maps need no mark: no photo has floating-point pixels.
"""

import struct
import zlib
from pathlib import Path
from uuid import UUID

from PIL import Image
from PIL.ExifTags import Base

from hdrlab.core.silence import ignore_library_warnings
from hdrlab.errors import InputError
from hdrlab.io import decode

SOFTWARE = "hdrlab"
# bytes of a PNG file up to the end of its first chunk, IHDR
PNG_HEADER_BYTES = 33
# the type of hdrlab's own box in ISO media files, any number that nobody else uses [ISO 14496-12 11.1]
OWN_BOX_TYPE = UUID("0c9fb2a8-5f0e-4d0b-9d4f-9d7f1a2c6e31")
BOX_HEADER_BYTES = 8
# the formats of photos that can hold floating-point pixels
FLOATING_SUFFIXES = (".tif", ".tiff", ".jxl")


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


def mark_avif(data: bytes) -> bytes:
    """Return an AVIF file with a box behind it that names the software."""
    return data + _own_box()


def _own_box() -> bytes:
    content = OWN_BOX_TYPE.bytes + SOFTWARE.encode("latin-1")
    return struct.pack(">I4s", BOX_HEADER_BYTES + len(content), b"uuid") + content


def is_own_picture(path: Path) -> bool:
    """Return whether an image file is a result of hdrlab; False for a file that cannot be opened."""
    if path.suffix.lower() == ".avif":
        return _ends_with(path, _own_box())
    try:
        # Pillow warns of odd EXIF, which does not matter here.
        with ignore_library_warnings(), Image.open(path) as image:
            named = image.info.get("Software") or image.getexif().get(Base.Software)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        return False
    return named == SOFTWARE


def is_radiance_map(path: Path) -> bool:
    """Return whether a file that may be a photo by its suffix has floating-point pixels."""
    if path.suffix.lower() not in FLOATING_SUFFIXES:
        return False
    try:
        decode.read_header(path, samples="floating")
    except (InputError, OSError):
        return False
    return True


def _ends_with(path: Path, mark: bytes) -> bool:
    try:
        with open(path, "rb") as file:
            size = file.seek(0, 2)
            file.seek(max(0, size - len(mark)))
            return file.read() == mark
    except OSError:
        return False
