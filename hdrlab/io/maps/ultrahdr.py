"""Ultra HDR: a JPEG with a gain map, from which a bright screen shows more light.

The file is two JPEGs, one behind the other. The first is the picture that every program shows. The
second is the gain map of `core.gainmap`, gray or RGB, often smaller. An index in the first says
where the second is (MPF, CIPA DC-007). The second states its metadata twice: in binary [ISO 21496-1]
and in XMP (Adobe's `hdrgm`), which older phones wrote alone. Apple's own gain maps are a different
format, which hdrlab does not read.

Gains of three channels depend on the primaries that they are meant in. A flag says which: those of
the picture, or those of the HDR rendition, which the profile of the gain map states. hdrlab applies
the gains there, to linear light that no gamut has cut, and converts the result to sRGB.
"""

import io
import re
import struct
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from hdrlab.core import colour, gainmap, gamut
from hdrlab.core.arrays import F32, F64, Array, ArrayLike, as_picture, as_radiance, describe
from hdrlab.core.silence import ignore_library_warnings
from hdrlab.errors import FileFormatError, InputError
from hdrlab.io import decode, files, profiles, web
from hdrlab.io.codecs import decode_jpeg, jpeg_end
from hdrlab.io.own_pictures import make_exif
from hdrlab.io.photos import PICTURES

# What the segments of a JPEG begin with: binary metadata, XMP, and the index.
ISO = b"urn:iso:std:iso:ts:21496:-1\0"
ADOBE = b"http://ns.adobe.com/xap/1.0/\0"
MPF = b"MPF\0"
APP1 = b"\xe1"
APP2 = b"\xe2"

# The flags of ISO 21496-1, by the standard's names.
FLAG_MULTICHANNEL = 0x80
FLAG_USE_BASE_COLOR_SPACE = 0x40
# libultrahdr's extensions: the picture is the HDR rendition; one denominator serves all fractions.
FLAG_BACKWARD_DIRECTION = 0x04
FLAG_COMMON_DENOMINATOR = 0x08
# The newest version of the metadata that hdrlab reads.
SUPPORTED_VERSION = 0
# Two headrooms, and for each channel min, max, gamma and two offsets.
HEADROOM_COUNT = 2
VALUES_PER_CHANNEL = 5
# Whether the numerators of a channel's values are signed: those of min, max and the offsets are.
# All denominators, and the numerators of headrooms and gamma, are unsigned.
HAS_SIGNED_NUMERATOR = (True, True, False, True, True)
DENOMINATOR = 2**20

# The properties of `hdrgm` in the order of ISO 21496-1, with their defaults; NaN has none.
XMP_HEADROOMS = {"HDRCapacityMin": 0.0, "HDRCapacityMax": np.nan}
XMP_CHANNEL_VALUES = {
    "GainMapMin": 0.0,
    "GainMapMax": np.nan,
    "Gamma": 1.0,
    "OffsetSDR": 1 / 64,
    "OffsetHDR": 1 / 64,
}

MAX_GAIN_STOPS = 64.0
MAX_HEADROOM = 2**16
# How the gain map is coded: as RGB, because a conversion to YCbCr would round it once more.
GAIN_MAP_ENCODING = {"quality": 100, "subsampling": 0, "keep_rgb": True}

# The index of two images: a TIFF block with three tags, then an entry for each image.
MPF_TAG_VERSION = 0xB000
MPF_TAG_NUMBER_OF_IMAGES = 0xB001
MPF_TAG_ENTRIES = 0xB002
MPF_ENTRIES_OFFSET = 50
MPF_ENTRIES_SIZE = 2 * 16
MPF_PRIMARY_IMAGE = 0x030000
TIFF_LONG = 4
TIFF_UNDEFINED = 7


@dataclass(frozen=True)
class GainMapMetadata:
    """What the values of a gain map mean; each field is a number for each channel, or for all.

    `low` and `high` are the gains of 0 and 1, in stops; `gamma` is the exponent of the values.
    `in_base_primaries` says whether the gains are meant in the primaries of the picture, or else in
    those of the gain map's profile.
    """

    low: F32
    high: F32
    gamma: F32
    offset_sdr: F32
    offset_hdr: F32
    in_base_primaries: bool


def read(path: str | Path) -> F32:
    """Read an Ultra HDR picture as the brightest screen shows it: radiance, in units of white.

    Parameters
    ----------
    path : the file

    Returns
    -------
    (H, W, 3) or (H, W) float32, upright, with the primaries of sRGB; colors that these cannot mix
    become less colorful, see `core.gamut.desaturate`

    Raises
    ------
    FileFormatError
        For a file that is no JPEG, is damaged, has no gain map, or has one of a newer version or
        for a picture that is itself the HDR rendition.
    InputError
        For a color profile that is damaged.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "lamp.jpg"
    >>> write_picture(file, np.full((8, 8), 188, np.uint8), np.full((8, 8), 3.0))
    >>> read(file).round(2)[0, 0].tolist()
    [0.5, 0.5, 0.5]
    """
    header = decode.read_header(path)
    pixels = np.empty(header.shape, header.dtype)
    decode.decode_photo(replace(header, icc=b""), pixels)
    base = profiles.to_linear(path, pixels, header.icc)
    try:
        second_jpeg = _find_gain_map_jpeg(Path(path).read_bytes())
        metadata = _read_metadata(second_jpeg)
        gains, gains_icc = _decode_gain_map(header, second_jpeg)
    except Exception as error:  # on damaged files the codecs raise exceptions of any type
        raise FileFormatError(
            f"{path}: expected a JPEG with a gain map, ISO's or hdrgm ({error!s:.99})"
        ) from None
    sdr = base.light
    to_srgb = base.to_srgb
    if gains_icc and not metadata.in_base_primaries:
        to_srgb = profiles.primaries_to_srgb(path, gains_icc)
        base_to_alternate = np.linalg.inv(to_srgb) @ base.to_srgb
        sdr = _convert_primaries(sdr, base_to_alternate)
    offsets = (metadata.offset_sdr, metadata.offset_hdr)
    hdr = gainmap.apply_gain(
        sdr, gains, metadata.low, metadata.high, gamma=metadata.gamma, k=offsets
    )
    hdr = _convert_primaries(hdr, to_srgb)
    if hdr.ndim == 3 and not np.array_equal(to_srgb, np.eye(3)):
        hdr = gamut.desaturate(hdr)
    return np.maximum(hdr, 0)


def write_picture(
    path: str | Path, picture: ArrayLike, E: ArrayLike, *, headroom: float = 8.0
) -> None:
    """Write a tone-mapped picture as JPEG with the gain map from which its radiance can be restored.

    Parameters
    ----------
    path : a .jpg or .jpeg file; what it held is replaced
    picture : (H, W) or (H, W, 3) uint8, tone-mapped by any operator: what programs show that do not
        know gain maps; gray becomes RGB, because other decoders refuse gray
    E : same shape, the radiance map from which the picture was made
    headroom : the brightest light that is kept, relative to white; a screen with less headroom
        applies a part of the gains

    Raises
    ------
    InputError
        For another suffix, shapes that differ, or a headroom that is not above 1.

    Examples
    --------
    >>> import tempfile
    >>> from hdrlab.io.photos import read_photo
    >>> file = Path(tempfile.mkdtemp()) / "wall.jpg"
    >>> write_picture(file, np.full((4, 6), 128, np.uint8), np.ones((4, 6)))
    >>> read_photo(file).shape
    (4, 6, 3)
    """
    encoding = PICTURES[files.require_suffix(path, (".jpg", ".jpeg"), "an Ultra HDR picture")]
    picture = web.as_rgb(as_picture(picture))
    E = web.as_rgb(as_radiance(E))
    if picture.shape != E.shape:
        raise InputError(
            f"expected picture and radiance of one shape, got {describe(picture)}, {describe(E)}"
        )
    if not 1 < headroom <= MAX_HEADROOM:
        raise InputError(f"expected a headroom of 1 to {MAX_HEADROOM}, got {headroom}")
    # The gains lead from the picture as it is decoded, with what JPEG has changed in it.
    decoded_picture = decode_jpeg(_encode_jpeg(picture, encoding))
    sdr = colour.decode_srgb(decoded_picture / np.float32(255))
    hdr = gainmap.expose(E, sdr, headroom)
    low, high = gainmap.find_range(gainmap.log_gain(sdr, hdr))
    gains = np.rint(255 * gainmap.gain_map(sdr, hdr, low, high)).astype(np.uint8)
    channel_values = np.vstack(np.broadcast_arrays(low, high, 1, *gainmap.OFFSETS))
    metadata = _metadata_segments(np.log2(headroom), channel_values)
    second_jpeg = _encode_jpeg(gains, GAIN_MAP_ENCODING, metadata)

    segments = _segment(APP1, ADOBE + _format_xmp("picture", length=len(second_jpeg)))
    segments += _segment(APP2, ISO + bytes(4))
    # The index has the length of the first JPEG, so it is filled in when that is known.
    placeholder = _mpf_index(0, 0, 0)
    segments += _segment(APP2, MPF + placeholder)
    first_jpeg = _encode_jpeg(picture, {**encoding, "exif": make_exif()}, segments)
    index_offset = first_jpeg.index(MPF) + len(MPF)
    index = _mpf_index(len(first_jpeg), len(second_jpeg), index_offset)
    files.write(path, first_jpeg.replace(placeholder, index) + second_jpeg)


def _convert_primaries(light: F32, matrix: F64) -> F32:
    """Return light (H, W, 3) in other primaries, by the matrix from the ones to the others."""
    if light.ndim == 2 or np.allclose(matrix, np.eye(3), rtol=0, atol=1e-12):
        return light
    return light @ matrix.T.astype(np.float32)


def _encode_jpeg(image: Array, encoding: dict[str, Any], segments: bytes = b"") -> bytes:
    file = io.BytesIO()
    Image.fromarray(image).save(file, "JPEG", extra=segments, **encoding)
    return file.getvalue()


def _segment(marker: bytes, body: bytes) -> bytes:
    """Return a segment of a JPEG."""
    return b"\xff" + marker + struct.pack(">H", len(body) + 2) + body


def _format_xmp(name: str, **values: object) -> bytes:
    """Return XMP by the template of that name, with its values filled in."""
    template = Path(__file__).with_name(f"ultrahdr_{name}.xmp").read_text("utf8")
    return template.format(**values).encode()


def _metadata_segments(headroom_stops: float, channel_values: Array) -> bytes:
    """Return the metadata of a gain map, in XMP and in binary.

    `channel_values` is (5, 3): min, max, gamma and two offsets of red, green and blue.
    """
    lists = {}
    for name, values in zip(XMP_CHANNEL_VALUES, channel_values, strict=True):
        lists[name] = "".join(f"<rdf:li>{value:.6f}</rdf:li>" for value in values)
    xmp = _format_xmp("gains", headroom=f"{headroom_stops:.6f}", **lists)

    numbers = np.concatenate([[0, headroom_stops], channel_values.T.ravel()])
    fractions = np.empty((len(numbers), 2), ">i4")
    fractions[:, 0] = np.rint(numbers * DENOMINATOR)
    fractions[:, 1] = DENOMINATOR
    minimum_version = 0
    writer_version = 0
    flags = FLAG_MULTICHANNEL | FLAG_USE_BASE_COLOR_SPACE
    binary = struct.pack(">2HB", minimum_version, writer_version, flags) + fractions.tobytes()
    return _segment(APP1, ADOBE + xmp) + _segment(APP2, ISO + binary)


def _mpf_index(first_size: int, second_size: int, index_offset: int) -> bytes:
    """Return the index of two JPEGs; its offsets count from itself [CIPA DC-007, 5.2]."""
    tag_count = 3
    no_next_directory = 0
    header = struct.pack(">2sHL", b"MM", 42, 8)
    directory = struct.pack(">H", tag_count)
    directory += struct.pack(">2HL4s", MPF_TAG_VERSION, TIFF_UNDEFINED, 4, b"0100")
    directory += struct.pack(">2H2L", MPF_TAG_NUMBER_OF_IMAGES, TIFF_LONG, 1, 2)
    directory += struct.pack(
        ">2H2L", MPF_TAG_ENTRIES, TIFF_UNDEFINED, MPF_ENTRIES_SIZE, MPF_ENTRIES_OFFSET
    )
    directory += struct.pack(">L", no_next_directory)
    # Attributes, size, offset, and two dependent images, of which there are none.
    first = struct.pack(">3L4x", MPF_PRIMARY_IMAGE, first_size, 0)
    second = struct.pack(">3L4x", 0, second_size, first_size - index_offset)
    return header + directory + first + second


def _find_gain_map_jpeg(data: bytes) -> bytes:
    """Return the first JPEG behind the picture that has the metadata of a gain map."""
    end = jpeg_end(data)
    while True:
        start = data.find(b"\xff\xd8\xff", end)
        if start < 0:
            raise FileFormatError(
                "it has no description of its gain map, as in Apple's files; take a bracket, or RAW"
            )
        end = jpeg_end(data, start)
        jpeg = data[start:end]
        if ISO in jpeg or b"hdrgm:GainMapMax" in jpeg:
            return jpeg


def _read_metadata(jpeg: bytes) -> GainMapMetadata:
    """Return the metadata of a gain map, from binary if it is there and from XMP otherwise."""
    start = jpeg.find(ISO)
    if start < 0:
        if re.search(rb'hdrgm:BaseRenditionIsHDR(="|>)\s*true', jpeg, re.IGNORECASE):
            raise FileFormatError(
                "the picture itself is the HDR rendition, which hdrlab cannot read"
            )
        values = _values_from_xmp(jpeg)
        # Adobe's description knows no other primaries.
        in_base_primaries = True
    else:
        body = jpeg[start + len(ISO) :]
        values = _values_from_binary(body)
        in_base_primaries = bool(_read_flags(body) & FLAG_USE_BASE_COLOR_SPACE)
    min_headroom, max_headroom = values[:HEADROOM_COUNT]
    channels = values[HEADROOM_COUNT:].reshape(-1, VALUES_PER_CHANNEL).T.astype(np.float32)
    low, high, gamma, offset_sdr, offset_hdr = channels
    metadata = GainMapMetadata(low, high, gamma, offset_sdr, offset_hdr, in_base_primaries)
    is_within_range = bool(np.all(np.abs(values) <= MAX_GAIN_STOPS))
    is_ordered = bool(np.all(metadata.low <= metadata.high)) and min_headroom < max_headroom
    if not (is_within_range and is_ordered and np.all(metadata.gamma > 1 / MAX_GAIN_STOPS)):
        limit = f"{MAX_GAIN_STOPS:.0f} stops"
        raise FileFormatError(
            f"expected gains within {limit}, toward more light, got {values.tolist()}"
        )
    return metadata


def _read_flags(body: bytes) -> int:
    """Return the flags of the metadata of ISO 21496-1, after a check that hdrlab can read it."""
    minimum_version, _, flags = struct.unpack_from(">2HB", body)
    if minimum_version > SUPPORTED_VERSION:
        raise FileFormatError(
            f"its gain map needs a reader of version {minimum_version}, "
            f"hdrlab reads version {SUPPORTED_VERSION}"
        )
    if flags & FLAG_BACKWARD_DIRECTION:
        raise FileFormatError("the picture itself is the HDR rendition, which hdrlab cannot read")
    return flags


def _values_from_binary(body: bytes) -> F64:
    """Return headrooms and channel values as ISO 21496-1 stores them: fractions behind flags."""
    flags = _read_flags(body)
    channels = 3 if flags & FLAG_MULTICHANNEL else 1
    is_signed = np.array((False,) * HEADROOM_COUNT + HAS_SIGNED_NUMERATOR * channels)
    count = len(is_signed)
    has_common_denominator = bool(flags & FLAG_COMMON_DENOMINATOR)
    stored = count + 1 if has_common_denominator else 2 * count
    numbers = np.frombuffer(body, ">u4", stored, struct.calcsize(">2HB"))
    if has_common_denominator:
        numerators = numbers[1:]
        denominators = numbers[:1]
    else:
        numerators = numbers[::2]
        denominators = numbers[1::2]
    signed_numerators = numerators.astype(np.uint32).view(np.int32)
    exact_numerators = np.where(is_signed, signed_numerators, numerators.astype(np.float64))
    with np.errstate(divide="ignore", invalid="ignore"):
        return exact_numerators / denominators


def _values_from_xmp(jpeg: bytes) -> F64:
    """Return headrooms and channel values of `hdrgm` in XMP, in the order of ISO 21496-1."""
    headrooms = []
    for name, default in XMP_HEADROOMS.items():
        headrooms += _xmp_numbers(jpeg, name, default)
    channel_values = []
    for name, default in XMP_CHANNEL_VALUES.items():
        channel_values.append(_xmp_numbers(jpeg, name, default))
    channels = np.transpose(np.broadcast_arrays(*channel_values))
    return np.concatenate([headrooms, channels.ravel()])


def _xmp_numbers(jpeg: bytes, name: str, default: float) -> list[float]:
    """Return the numbers of a property, which is an attribute or an element with a list."""
    pattern = rf'hdrgm:{name}(?:="([^"]*)"|>(.*?)</hdrgm:{name}>)'.encode()
    match = re.search(pattern, jpeg, re.DOTALL)
    if match is None:
        return [default]
    text = re.sub(rb"<[^>]*>", b" ", match[1] or match[2])
    return [float(number) for number in text.split()] or [default]


def _decode_gain_map(header: decode.PhotoHeader, jpeg: bytes) -> tuple[F32, bytes]:
    """Return the values of the gain map and its profile.

    The values are upright, with the size and channels of the picture.
    """
    height, width = header.shape[:2]
    if header.orientation > 4:
        height, width = width, height
    mode = "L" if len(header.shape) == 2 else "RGB"
    # Pillow warns about the EXIF of the gain map, which nobody needs.
    with (
        ignore_library_warnings(),
        Image.open(io.BytesIO(jpeg), formats=("JPEG",)) as image,
    ):
        min_bytes = image.height * image.width // decode.BEST_COMPRESSION_RATIO
        files.check_size(header.path, image.height, image.width, min_bytes, available=len(jpeg))
        icc = image.info.get("icc_profile") or b""
        gains = image.convert(mode).resize((width, height))
    values = decode.upright(np.asarray(gains, np.float32) / 255, header.orientation)
    return values, icc
