"""Decode the pixels of one file as they are stored, by a decoder for each format.

simplejpeg decodes JPEG, because it reports what libjpeg only warns of: imagecodecs and Pillow fill
the missing parts of a damaged JPEG with gray or with shifted blocks, and say nothing. imagecodecs
decodes PNG, because it keeps all 16 bits (Pillow cuts RGB to 8) and writes into an array that is
given, and AVIF of more than 8 bits. Pillow decodes WebP and other AVIF, pillow-heif HEIC, and
tifffile TIFF, see `hdrlab.io.tiff_pages`.
"""

import io
import logging
import re
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from PIL import Image

from hdrlab.core.arrays import Array
from hdrlab.core.optional import imagecodecs, pillow_heif, simplejpeg
from hdrlab.errors import FileFormatError, InputError
from hdrlab.io import jpegxl, tiff_pages

# hdrlab's own errors report what is wrong with a file.
for codec in ("tifffile", "imagecodecs"):
    logging.getLogger(codec).addHandler(logging.NullHandler())

# A marker of JPEG that is neither a coded 255 nor a restart within the coded pixels.
JPEG_MARKER = re.compile(rb"\xff([\x01-\xcf\xd8-\xfe])")
JPEG_END_OF_IMAGE = 0xD9
PNG_BIT_DEPTH_OFFSET = 24
PNG_COLOR_TYPE_OFFSET = 25
PNG_ALPHA_FLAG = 4
# The flags of av1C, the configuration of AV1 [AV1-ISOBMFF 2.3].
AV1_FLAGS_OFFSET = 6
AV1_HIGH_BITDEPTH_FLAG = 0x40
AV1_TWELVE_BIT_FLAG = 0x20

Decoder = Callable[[bytes, Array | None], Array]


def decode_stored_pixels(path: Path, kind: str, out: Array | None = None) -> Array:
    """Return the pixels of a file as they are stored.

    Parameters
    ----------
    path
        The file.
    kind
        Its format, a key of `DECODERS`.
    out
        An array for the pixels. Decoders that cannot write into one return another.

    Raises
    ------
    FileFormatError
        For a damaged file.
    InputError
        If there is not enough memory.
    """
    data = path.read_bytes()
    try:
        return DECODERS[kind](data, out)
    except ModuleNotFoundError:  # without its codec, a file may still be good
        raise
    except MemoryError:
        raise InputError(f"{path}: there is not enough memory to decode it") from None
    except Exception as error:  # on damaged files the codecs raise exceptions of any type
        reason = str(error)[:200] or type(error).__name__
        raise FileFormatError(f"{path}: it is cut short or damaged ({reason})") from None


def jpeg_parts(data: bytes, start: int = 0) -> Iterator[tuple[int, int, int]]:
    """Yield (marker, start, end) of the parts of a JPEG, without markers and lengths.

    What stands between two segments has the marker 0: coded pixels, fill bytes, or damage.

    Raises
    ------
    FileFormatError
        For a JPEG without an end: libjpeg fills what is missing with gray, and only warns.
    """
    offset = start + 2
    while True:
        match = JPEG_MARKER.search(data, offset)
        if match is None:
            raise FileFormatError("no end of image after its last scan")
        if match.start() > offset:
            yield 0, offset, match.start()
        marker = match[1][0]
        offset = match.end()
        if marker == JPEG_END_OF_IMAGE:
            yield marker, offset, offset
            return
        end = offset + int.from_bytes(data[offset : offset + 2], "big")
        yield marker, min(offset + 2, end), end
        offset = end


def jpeg_end(data: bytes, start: int = 0) -> int:
    """Return where the JPEG at `start` ends, whatever follows it, such as a film or a gain map."""
    end = start
    for _, _, part_end in jpeg_parts(data, start):
        end = part_end
    return end


def decode_jpeg(data: bytes, out: Array | None = None) -> Array:
    """Decode a JPEG, without what follows it.

    Pillow decodes it where simplejpeg is not installed, and then nobody reports damaged parts.

    Raises
    ------
    ValueError
        For a JPEG of which any part is damaged or missing.
    """
    data = data[: jpeg_end(data)]
    if not simplejpeg:
        return decode_by_pillow(data)
    height, width, color_space, _ = simplejpeg.decode_jpeg_header(data)
    is_gray = color_space == "Gray"
    shape = (height, width) if is_gray else (height, width, 3)
    if out is None or out.shape != shape or not out.flags.c_contiguous:
        out = np.empty(shape, np.uint8)
    simplejpeg.decode_jpeg(data, "GRAY" if is_gray else "RGB", buffer=out, strict=True)
    return out


def decode_png(data: bytes, out: Array | None = None) -> Array:
    """Decode a PNG; one with alpha is not decoded into `out`, which has no place for alpha."""
    if data[PNG_COLOR_TYPE_OFFSET] & PNG_ALPHA_FLAG:
        out = None
    if imagecodecs.has_codec("PNG") or data[PNG_BIT_DEPTH_OFFSET] > 8:
        return imagecodecs.png_decode(data, out=out)
    return decode_by_pillow(data)


def decode_by_pillow(data: bytes, out: Array | None = None) -> Array:
    """Decode 8 bits a channel: WebP and AVIF, and the others where imagecodecs lacks their codec."""
    with Image.open(io.BytesIO(data), formats=("JPEG", "PNG", "WEBP", "AVIF")) as image:
        return np.asarray(image)


def decode_avif(data: bytes, out: Array | None = None) -> Array:
    """Decode the first image of an AVIF."""
    depth = avif_depth(data)
    if depth == 8 and not imagecodecs.has_codec("AVIF"):
        return decode_by_pillow(data)
    pixels = imagecodecs.avif_decode(data, index=0)
    return pixels if depth == 8 else _fill_16_bits(pixels << (16 - depth), depth)


def avif_depth(data: bytes) -> int:
    """Return how many bits a channel an AVIF has: 8, 10 or 12."""
    flags = data[data.find(b"av1C") + AV1_FLAGS_OFFSET]
    if not flags & AV1_HIGH_BITDEPTH_FLAG:
        return 8
    return 12 if flags & AV1_TWELVE_BIT_FLAG else 10


def decode_heic(data: bytes, out: Array | None = None) -> Array:
    """Decode the first image of a HEIC."""
    image = pillow_heif.open_heif(io.BytesIO(data), convert_hdr_to_8bit=False)
    # A copy: before pillow-heif 1.6, the pixels are only valid as long as `image` exists.
    pixels = np.array(image)
    if pixels.dtype == np.uint8:
        return pixels
    return _fill_16_bits(pixels, image.info["bit_depth"])


def decode_jxl(data: bytes, out: Array | None = None) -> Array:
    """Decode a JPEG XL into an array of the size that its header states, and refuse another size."""
    header = jpegxl.read_header("", data)
    if out is None:
        out = np.empty(header.shape, header.dtype)
    pixels = imagecodecs.jpegxl_decode(data, keeporientation=True, out=out)
    if header.dtype != np.uint16:
        return pixels
    depth = header.bits_per_sample
    return _fill_16_bits(pixels << (16 - depth), depth)


def _fill_16_bits(pixels: Array, depth: int) -> Array:
    """Spread values of `depth` bits, which are the upper ones of 16, over all: white is 65535."""
    return pixels | pixels >> depth


DECODERS: dict[str, Decoder] = {
    "JPEG": decode_jpeg,
    "PNG": decode_png,
    "TIFF": tiff_pages.decode_photo,
    "WEBP": decode_by_pillow,
    "AVIF": decode_avif,
    "HEIF": decode_heic,
    "JXL": decode_jxl,
}
