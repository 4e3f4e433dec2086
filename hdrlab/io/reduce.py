"""Reduce large photos before they are read, for machines with little memory, such as a browser's tab.

A JPEG is decoded at a half, a quarter or an eighth of its size, which takes a fraction of the time
and of the memory. The rest of the way, each pixel is a weighted mean of those that it covers.
"""

import math
from dataclasses import replace
from pathlib import Path

from PIL import Image

from hdrlab.core.silence import ignore_library_warnings
from hdrlab.errors import FileFormatError
from hdrlab.io.decode import PhotoHeader

# Pillow's formats that `reduce_photo` reads.
READABLE_FORMATS = ("JPEG", "PNG")
# The result is deleted soon, so it is compressed quickly.
PNG_COMPRESS_LEVEL = 1


def reduced_size(width: int, height: int, max_pixels: int) -> tuple[int, int]:
    """Return the largest size with the same proportions that has at most `max_pixels` pixels.

    Examples
    --------
    >>> reduced_size(4000, 3000, 2_000_000), reduced_size(400, 300, 2_000_000)
    ((1632, 1224), (400, 300))
    """
    scale = min(1.0, math.sqrt(max_pixels / (width * height)))
    return max(1, int(scale * width)), max(1, int(scale * height))


def reduce_photo(header: PhotoHeader, out: Path, max_pixels: int) -> PhotoHeader:
    """Write a smaller copy of a photo as PNG, and return its header.

    The header keeps what the photo states: its exposure, its orientation and the profile of its
    colors, of which the copy itself has none.

    Parameters
    ----------
    header : what `decode.read_header` returned for an 8-bit JPEG or PNG
    out : the file to write
    max_pixels : how many pixels the copy has at most

    Raises
    ------
    FileFormatError
        For a damaged photo.
    """
    path = header.path
    try:
        with ignore_library_warnings(), Image.open(path, formats=READABLE_FORMATS) as image:
            size = reduced_size(*image.size, max_pixels)
            image.draft(None, size)  # a JPEG is decoded at the smallest of its sizes above this
            small = image.resize(size, Image.Resampling.BILINEAR)
            small.save(out, "PNG", compress_level=PNG_COMPRESS_LEVEL, icc_profile=None)
    except (OSError, SyntaxError, ValueError) as error:  # as Pillow's decoders report damage
        raise FileFormatError(f"{path}: expected a photo, it is damaged ({error})") from None
    width, height = size if header.orientation < 5 else size[::-1]
    return replace(header, path=out, kind="PNG", shape=(height, width, *header.shape[2:]))
