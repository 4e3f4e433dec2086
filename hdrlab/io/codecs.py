"""The pixels of one file as they are stored, by a decoder for each kind of file.

JPEG and PNG are decoded by imagecodecs, which keeps all 16 bits (Pillow cuts RGB to 8) and writes
into an array that is there; so is AVIF of more bits than 8. Pillow decodes WebP and other AVIF,
pillow-heif HEIC, tifffile TIFF.
"""

import io
import logging
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from PIL import Image

from hdrlab.core.arrays import Array
from hdrlab.core.optional import imagecodecs, pillow_heif, tifffile
from hdrlab.errors import InputError
from hdrlab.io import jpegxl

for codec in ("tifffile", "imagecodecs"):  # our errors report what is wrong
    logging.getLogger(codec).addHandler(logging.NullHandler())

# of JPEG: what is neither a byte of coded pixels nor a restart within them
MARKER = re.compile(rb"\xff([\x01-\xcf\xd8-\xfe])")


def stored_pixels(path: Path, kind: str, out: Array | None = None) -> Array:
    """Return the pixels of a file of that kind as they are stored, or raise a ValueError if it is damaged."""
    data = path.read_bytes()
    try:
        return DECODERS[kind](data, out)
    except ModuleNotFoundError:  # no codec: the file may be good
        raise
    except Exception as error:  # on damaged files the codecs raise what they like
        why = str(error)[:200] or type(error).__name__
        raise InputError(f"{path}: it is cut short or damaged ({why})") from None


def jpeg_parts(data: bytes, start: int = 0) -> Iterator[tuple[int, int, int]]:
    """Yield (marker, from, to) of what the JPEG at `start` is made of, without markers and lengths.

    What stands between two segments has marker 0: coded pixels, bytes that fill, or what damage
    left there.

    Raises
    ------
    ValueError
        Where it has no end: libjpeg fills what is missing with gray, and only warns.
    """
    at = start + 2
    while found := MARKER.search(data, at):
        if found.start() > at:
            yield 0, at, found.start()
        at = found.end()
        end = at if found[1] == b"\xd9" else at + int.from_bytes(data[at : at + 2])
        yield found[1][0], min(at + 2, end), end
        if found[1] == b"\xd9":
            return
        at = end
    raise InputError("no end of image after its last scan")


def jpeg_end(data: bytes, start: int = 0) -> int:
    """Return where the JPEG at `start` ends, whatever follows it, such as a film or a gain map."""
    *_, (_, _, end) = jpeg_parts(data, start)
    return end


def _jpeg(data: bytes, out: Array | None) -> Array:
    data = data[: jpeg_end(data)]
    return imagecodecs.jpeg8_decode(data, out=out) if imagecodecs else _pillow(data)


def _png(data: bytes, out: Array | None) -> Array:
    out = None if data[25] & 4 else out  # of the colour type: it has alpha, which `out` has not
    return imagecodecs.png_decode(data, out=out) if imagecodecs or data[24] > 8 else _pillow(data)


def _pillow(data: bytes, out: Array | None = None) -> Array:
    """Decode 8 bits a channel: WebP and AVIF, and the others where imagecodecs is not installed."""
    with Image.open(io.BytesIO(data), formats=("JPEG", "PNG", "WEBP", "AVIF")) as image:
        return np.asarray(image)


def _avif(data: bytes, out: Array | None) -> Array:
    if (depth := avif_depth(data)) == 8 and not imagecodecs:
        return _pillow(data)
    pixels = imagecodecs.avif_decode(data, index=0)
    return pixels if depth == 8 else _fill(pixels << (16 - depth), depth)


def avif_depth(data: bytes) -> int:
    """Return 8, 10 or 12 bits a channel: the flags high_bitdepth and twelve_bit [AV1-ISOBMFF 2.3]."""
    at = data.find(b"av1C") + 6
    return 8 + 2 * (data[at] >> 6 & 1) * (1 + (data[at] >> 5 & 1))


def _heic(data: bytes, out: Array | None) -> Array:
    image = pillow_heif.open_heif(io.BytesIO(data), convert_hdr_to_8bit=False)
    pixels = np.asarray(image)
    return pixels if pixels.dtype == np.uint8 else _fill(pixels, image.info["bit_depth"])


def _jxl(data: bytes, out: Array | None) -> Array:
    """Decode into an array of the size that was looked at: another is refused before a pixel is decoded."""
    header = jpegxl.read_header("", data)
    if out is None:
        out = np.empty(header.shape, header.dtype)
    pixels = imagecodecs.jpegxl_decode(data, keeporientation=True, out=out)
    if header.dtype != np.uint16:
        return pixels
    depth = header.bits_per_sample
    return _fill(pixels << (16 - depth), depth)


def _fill(pixels: Array, depth: int) -> Array:
    """Return levels of `depth` bits, which are the upper ones of 16, spread over all: white is 65535."""
    return pixels | pixels >> depth


def _tiff(data: bytes, out: Array | None) -> Array:
    with tifffile.TiffFile(io.BytesIO(data)) as file:
        page = file.pages.first
        ends = map(sum, zip(page.dataoffsets, page.databytecounts, strict=True))
        if max(ends, default=0) > len(data) or np.prod(page.chunks) > max(
            4 * np.prod(page.shape), 1 << 24
        ):
            raise InputError(
                "its pixels go past the end of the file, or its tiles far beyond its picture"
            )
        pixels = page.asarray()
    if page.planarconfig == tifffile.PLANARCONFIG.SEPARATE and pixels.ndim == 3:
        pixels = np.moveaxis(pixels, 0, -1)
    return pixels.astype(pixels.dtype.newbyteorder("="), copy=False)


DECODERS = {
    "JPEG": _jpeg,
    "PNG": _png,
    "TIFF": _tiff,
    "WEBP": _pillow,
    "AVIF": _avif,
    "HEIF": _heic,
}
DECODERS["JXL"] = _jxl
