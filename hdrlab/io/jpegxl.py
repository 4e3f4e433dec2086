"""The headers of JPEG XL: size, samples, color encoding and frames [ISO 18181-1, annexes D and F].

A file is a bare codestream, or boxes of which one or several hold the codestream. A header is a
sequence of bits, the lowest of each byte first.

hdrlab reads images with the primaries of sRGB, with any transfer function (floats are linear), and
8-bit or 16-bit images of Display P3. It refuses other colors, alpha and animations. libjxl accepts
any size of a frame, so that a few hundred bytes could keep it busy for hours; hdrlab therefore
reads files with one frame of the image's own size only.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hdrlab.core.optional import imagecodecs
from hdrlab.errors import FileFormatError
from hdrlab.io.boxes import iter_boxes
from hdrlab.io.files import OtherPixels

MAX_HEADER_BYTES = 64
MAX_EXIF_BYTES = 2**16
# Width over height, by the number of the ratio; 0 states the width itself.
ASPECT_RATIOS = {1: (1, 1), 2: (6, 5), 3: (4, 3), 4: (3, 2), 5: (16, 9), 6: (5, 4), 7: (2, 1)}

# The four ways in which the format stores a number: an offset, and the bits that are added to it.
ENUM_CODES = ((0, 0), (1, 0), (2, 4), (18, 6))
SIZE_CODES = ((1, 9), (1, 13), (1, 18), (1, 30))
INTEGER_DEPTH_CODES = ((8, 0), (10, 0), (12, 0), (1, 6))
FLOAT_DEPTH_CODES = ((32, 0), (16, 0), (24, 0), (1, 6))
EXTRA_CHANNELS_CODES = ((0, 0), (1, 0), (2, 4), (1, 12))
FRAME_FLAGS_CODES = ((0, 0), (1, 4), (17, 8), (0, 12))
PASSES_CODES = ((1, 0), (2, 0), (3, 0), (4, 3))
DOWNSAMPLINGS_CODES = ((0, 0), (1, 0), (2, 0), (3, 1))
LAST_PASS_CODES = ((0, 0), (1, 0), (2, 0), (0, 3))
TONE_MAPPING_BITS = 49

# Bits a sample that hdrlab reads.
INTEGER_DEPTHS = range(8, 17)
FLOAT_DEPTHS = (16, 32)

# Color spaces, white points, primaries and transfer functions by their numbers [ITU-T H.273].
RGB_SPACE = 0
GRAY_SPACE = 1
D65_WHITE_POINT = 1
SRGB_PRIMARIES = 1
P3_PRIMARIES = 11
UNKNOWN_PRIMARIES = 0
GAMMA_TRANSFER = 0
LINEAR_TRANSFER = 8
SRGB_TRANSFER = 13
PQ_TRANSFER = 16
HLG_TRANSFER = 18


@dataclass(frozen=True)
class JxlHeader:
    """What a JPEG XL file states about its pixels, as they are stored.

    `transfer` and `primaries` are numbers of H.273.
    """

    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    bits_per_sample: int
    orientation: int
    transfer: int
    primaries: int


@dataclass(frozen=True)
class ColorEncoding:
    """The colors of an image, by the numbers of H.273; unknown primaries are those of a profile."""

    primaries: int = SRGB_PRIMARIES
    is_gray: bool = False
    transfer: int = SRGB_TRANSFER


@dataclass(frozen=True)
class ImageMetadata:
    """What stands in the header behind the size; the defaults are those of the standard."""

    orientation: int = 1
    is_float: bool = False
    bits_per_sample: int = 8
    extra_channels: int = 0
    is_xyb: bool = True
    color: ColorEncoding = ColorEncoding()
    is_animation_or_preview: bool = False
    has_extensions: bool = False


class BitReader:
    """Reads numbers from a sequence of bits; behind its end all bits are 0."""

    def __init__(self, data: bytes) -> None:
        self._bits = int.from_bytes(data, "little")
        self._position = 0

    def read(self, count: int) -> int:
        """Return the number in the next `count` bits."""
        value = self._bits >> self._position & ((1 << count) - 1)
        self._position += count
        return value

    def read_bool(self) -> bool:
        """Return whether the next bit is 1."""
        return self.read(1) == 1

    def read_coded(self, codes: tuple[tuple[int, int], ...]) -> int:
        """Return a number that is stored in one of four ways."""
        offset, count = codes[self.read(2)]
        return offset + self.read(count)

    def read_enum(self) -> int:
        """Return the number of a color space, a white point, primaries or a transfer function."""
        return self.read_coded(ENUM_CODES)

    def skip_to_next_byte(self) -> None:
        """Skip the rest of the byte."""
        self.read(-self._position % 8)


def codestream(data: bytes) -> bytes:
    """Return the first bytes of the codestream, which is the whole file or is stored in boxes."""
    if data[:1] == b"\xff":
        return data
    sequence_number_size = 4
    stream = b""
    for box in iter_boxes(data):
        if box.type == b"jxlc":
            start = box.content_start
        elif box.type == b"jxlp":
            start = box.content_start + sequence_number_size
        else:
            continue
        stream += data[start : min(box.end, start + MAX_HEADER_BYTES)]
    return stream


def exif(data: bytes) -> bytes:
    """Return the EXIF of a file, or nothing; it may be compressed by Brotli."""
    tiff_offset_size = 4
    for box in iter_boxes(data):
        content = data[box.content_start : box.end]
        if box.type == b"Exif":
            return content[tiff_offset_size:]
        if box.type == b"brob" and content[:4] == b"Exif":
            buffer = bytearray(MAX_EXIF_BYTES)
            return bytes(imagecodecs.brotli_decode(content[4:], out=buffer))[tiff_offset_size:]
    return b""


def read_header(path: str | Path, head: bytes) -> JxlHeader:
    """Return what a JPEG XL file states about its pixels.

    Parameters
    ----------
    path
        The file, to be named in errors.
    head
        The beginning of the file.

    Raises
    ------
    FileFormatError
        For a file without a codestream.
    OtherPixels
        For an image that hdrlab does not read.
    """
    try:
        data = codestream(head)
    except FileFormatError as error:
        raise FileFormatError(f"{path}: the header is damaged ({error})") from None
    if not data:
        raise FileFormatError(f"{path}: the header is damaged (it has no codestream)")
    signature_size = 2
    bits = BitReader(data[signature_size:MAX_HEADER_BYTES])
    height, width = _read_size(bits)
    metadata = _read_image_metadata(bits)
    _require_readable(path, metadata)
    has_usual_transforms = bits.read_bool()
    if metadata.has_extensions or not has_usual_transforms or not _is_only_frame(bits, metadata):
        raise OtherPixels(
            f"{path}: expected one frame of the image's size; save the image without layers or animation"
        )
    bytes_per_sample = (metadata.bits_per_sample + 7) // 8
    kind = "f" if metadata.is_float else "u"
    return JxlHeader(
        shape=(height, width) if metadata.color.is_gray else (height, width, 3),
        dtype=np.dtype(f"{kind}{bytes_per_sample}"),
        bits_per_sample=metadata.bits_per_sample,
        orientation=metadata.orientation,
        transfer=metadata.color.transfer,
        primaries=metadata.color.primaries,
    )


def _require_readable(path: str | Path, metadata: ImageMetadata) -> None:
    """Raise OtherPixels for an image that hdrlab does not read."""
    if metadata.is_animation_or_preview:
        raise OtherPixels(f"{path}: expected one image, got an animation or a preview as well")
    depths = FLOAT_DEPTHS if metadata.is_float else INTEGER_DEPTHS
    if metadata.extra_channels or metadata.bits_per_sample not in depths:
        samples = f"{metadata.bits_per_sample} bits and {metadata.extra_channels} more channels"
        raise OtherPixels(f"{path}: expected gray or RGB of 8 or 16 bits, got {samples}")
    color = metadata.color
    is_srgb = color.primaries == SRGB_PRIMARIES
    is_display_p3 = color.primaries == P3_PRIMARIES and color.transfer == SRGB_TRANSFER
    if not is_srgb and not (is_display_p3 and not metadata.is_float):
        raise OtherPixels(
            f"{path}: expected sRGB or Display P3, got another color space; convert the file"
        )
    if metadata.is_float and color.transfer != LINEAR_TRANSFER:
        raise OtherPixels(
            f"{path}: expected linear floats, got the transfer function {color.transfer} of H.273"
        )


def _read_size(bits: BitReader) -> tuple[int, int]:
    """Return height and width."""
    is_small = bits.read_bool()
    height = _read_side(bits, is_small=is_small)
    ratio = bits.read(3)
    if ratio == 0:
        return height, _read_side(bits, is_small=is_small)
    numerator, denominator = ASPECT_RATIOS[ratio]
    return height, height * numerator // denominator


def _read_side(bits: BitReader, *, is_small: bool) -> int:
    """Return height or width; small images store a multiple of 8."""
    if is_small:
        return 8 + 8 * bits.read(5)
    return bits.read_coded(SIZE_CODES)


def _read_image_metadata(bits: BitReader) -> ImageMetadata:
    if bits.read_bool():  # all values are the defaults
        return ImageMetadata()
    has_extra_fields = bits.read_bool()
    orientation = 1
    if has_extra_fields:
        orientation = 1 + bits.read(3)
        if bits.read_bool():
            _read_size(bits)  # the intrinsic size
        has_preview = bits.read_bool()
        has_animation = bits.read_bool()
        if has_preview or has_animation:
            return ImageMetadata(is_animation_or_preview=True)
    is_float = bits.read_bool()
    if is_float:
        depth = bits.read_coded(FLOAT_DEPTH_CODES)
        bits.read(4)  # bits of the exponent
    else:
        depth = bits.read_coded(INTEGER_DEPTH_CODES)
    bits.read_bool()  # whether 16-bit buffers suffice for the decoder
    extra_channels = bits.read_coded(EXTRA_CHANNELS_CODES)
    is_xyb = bits.read_bool()
    if extra_channels:
        # Their descriptions follow; hdrlab refuses the image, so nothing more is read.
        return ImageMetadata(bits_per_sample=depth, extra_channels=extra_channels)
    color = _read_color_encoding(bits)
    if has_extra_fields and not bits.read_bool():
        bits.read(TONE_MAPPING_BITS)
    return ImageMetadata(
        orientation=orientation,
        is_float=is_float,
        bits_per_sample=depth,
        is_xyb=is_xyb,
        color=color,
        has_extensions=bits.read(2) != 0,
    )


def _read_color_encoding(bits: BitReader) -> ColorEncoding:
    if bits.read_bool():  # all values are the defaults
        return ColorEncoding()
    has_profile = bits.read_bool()
    space = bits.read_enum()
    white_point = bits.read_enum()
    primaries = SRGB_PRIMARIES if space == GRAY_SPACE else bits.read_enum()
    if bits.read_bool():
        bits.read(24)  # the exponent
        transfer = GAMMA_TRANSFER
    else:
        transfer = bits.read_enum()
    bits.read_enum()  # the rendering intent
    if has_profile or space not in (RGB_SPACE, GRAY_SPACE) or white_point != D65_WHITE_POINT:
        primaries = UNKNOWN_PRIMARIES
    return ColorEncoding(primaries, space == GRAY_SPACE, transfer)


def _is_only_frame(bits: BitReader, metadata: ImageMetadata) -> bool:
    """Return whether the frame that begins here is the only one, and has the image's size."""
    bits.skip_to_next_byte()
    if bits.read_bool():  # all values are the defaults
        return True
    is_regular = bits.read(2) == 0
    is_modular = bits.read_bool()
    bits.read_coded(FRAME_FLAGS_CODES)
    if not metadata.is_xyb and bits.read_bool():
        bits.read(6)  # the subsampling of YCbCr
    bits.read(2)  # the upsampling
    if is_modular:
        bits.read(2)  # the size of a group
    elif metadata.is_xyb:
        bits.read(6)  # the scales of two quantization matrices
    passes = bits.read_coded(PASSES_CODES)
    if passes > 1:
        downsamplings = bits.read_coded(DOWNSAMPLINGS_CODES)
        bits.read(2 * (passes - 1))  # the shifts
        bits.read(2 * downsamplings)  # their factors
        for _ in range(downsamplings):
            bits.read_coded(LAST_PASS_CODES)
    has_crop = bits.read_bool()
    blend_mode = bits.read(2)
    is_last = bits.read_bool()
    return is_regular and is_last and not has_crop and blend_mode == 0
