"""Scan-line OpenEXR in NumPy, where the official module is not installed, as in a browser.

file    magic number, version, the header of each part, a table of offsets for each part, and chunks
header  attributes: name, type, size and value, the names ending in a zero byte
chunk   1 row, or 16 rows with ZIP: for each row and each channel, in the order of their names, the
        row's pixels of that channel

ZIP and ZIPS compress a chunk in three steps. All even bytes come first, then all odd ones, so that
the exponents of floats stand together. Each byte becomes its difference to the byte before, plus
128. Then zlib compresses the differences. A chunk that does not get smaller is stored as it is.

The other methods, tiles and deep data need the official module [OpenEXR File Layout, openexr.com].
"""

import struct
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

import numpy as np

from hdrlab.core.arrays import Array
from hdrlab.errors import FileFormatError

MAGIC_AND_VERSION = struct.Struct("<II")
MAGIC = 20000630
VERSION = 2
MULTI_PART_FLAG = 0x1000
VERSION_MASK = 0xFF
CHANNEL = struct.Struct("<iB3xii")
WINDOW = struct.Struct("<4i")
INTEGER = struct.Struct("<i")
OFFSET_BYTES = 8
# types of pixels, by their numbers in the header
PIXEL_DTYPES = {0: "<u4", 1: "<f2", 2: "<f4"}
PIXEL_TYPES = {"uint32": 0, "float16": 1, "float32": 2}
# attributes that are numbers
NUMBER_FORMATS = {
    "int": "<1i",
    "float": "<1f",
    "double": "<1d",
    "v2i": "<2i",
    "v2f": "<2f",
    "v3f": "<3f",
    "chromaticities": "<8f",
    "m33f": "<9f",
    "m44f": "<16f",
}
ZIP_ROWS = 16
# what zlib or a wrong size raises in a damaged file
DAMAGE_ERRORS = (struct.error, zlib.error, ValueError, IndexError, KeyError, OverflowError)


class Storage(IntEnum):
    """How a part stores its pixels, with the names of the official module."""

    scanlineimage = 0
    tiledimage = 1
    deepscanline = 2
    deeptile = 3


class Compression(IntEnum):
    """How chunks are compressed, with the names of the official module."""

    NO_COMPRESSION = 0
    RLE_COMPRESSION = 1
    ZIPS_COMPRESSION = 2
    ZIP_COMPRESSION = 3
    PIZ_COMPRESSION = 4
    PXR24_COMPRESSION = 5
    B44_COMPRESSION = 6
    B44A_COMPRESSION = 7
    DWAA_COMPRESSION = 8
    DWAB_COMPRESSION = 9


# rows in a chunk, by the methods that this module reads
ROWS_PER_CHUNK = {
    Compression.NO_COMPRESSION: 1,
    Compression.ZIPS_COMPRESSION: 1,
    Compression.ZIP_COMPRESSION: ZIP_ROWS,
}


@dataclass(frozen=True)
class Channel:
    """A channel in the list of a header: its name, its dtype, and every how many pixels it has one."""

    name: str
    dtype: str
    x_step: int
    y_step: int


@dataclass(frozen=True)
class NewPart:
    """A part to write.

    Attributes
    ----------
    planes : images (H, W) of float16 or float32, by channel
    name : of the part, "" for the only one
    attributes : texts and numbers for the header
    """

    planes: Mapping[str, Array]
    name: str = ""
    attributes: Mapping[str, str | float] = field(default_factory=dict)


def read_parts(
    data: bytes, count: int | None = None, *, header_only: bool = False
) -> list[tuple[dict[str, Any], dict[str, Array]]]:
    """Return the header and the pixels by channel of the first `count` parts of a file.

    Raises
    ------
    FileFormatError
        For a file that is damaged, and for a kind of pixels that this module does not read.
    """
    try:
        _, version = MAGIC_AND_VERSION.unpack_from(data)
        is_multi_part = bool(version & MULTI_PART_FLAG)
        headers, start = _read_headers(data, is_multi_part)
        if header_only:
            return [(_public(header), {}) for header in headers[:count]]
        parts = []
        for header in headers[: len(headers) if count is None else count]:
            offset_count = _count_chunks(header)
            offsets = np.frombuffer(data, "<u8", offset_count, start).tolist()
            start += OFFSET_BYTES * offset_count
            planes = _read_planes(data, header, offsets, is_multi_part)
            parts.append((_public(header), planes))
        return parts
    except FileFormatError:
        raise
    except DAMAGE_ERRORS as error:
        raise FileFormatError(f"a part cannot be read: {error}") from None


def _public(header: dict[str, Any]) -> dict[str, Any]:
    """Return a header with each channel as its name and its steps, as `exr` expects it."""
    channels = [(channel.name, channel.x_step, channel.y_step) for channel in header["channels"]]
    return header | {"channels": channels}


def _read_headers(data: bytes, is_multi_part: bool) -> tuple[list[dict[str, Any]], int]:
    """Return the headers, and where the tables of offsets start."""
    headers = []
    start = MAGIC_AND_VERSION.size
    while True:
        header, start = _read_header(data, start)
        headers.append(header)
        if not is_multi_part:
            return headers, start
        if data[start] == 0:
            return headers, start + 1


def _read_header(data: bytes, start: int) -> tuple[dict[str, Any], int]:
    """Return the attributes of a part, and where the next thing starts."""
    header: dict[str, Any] = {}
    while data[start] != 0:
        name, start = _read_text(data, start)
        kind, start = _read_text(data, start)
        (size,) = INTEGER.unpack_from(data, start)
        start += INTEGER.size
        if not 0 <= size <= len(data) - start:
            raise FileFormatError(f"the attribute {name[:40]} is cut short")
        header[name] = _parse_attribute(kind, data[start : start + size])
        start += size
    names = [storage.name for storage in Storage]
    stated = header.get("type", "tiledimage" if "tiles" in header else "scanlineimage")
    header["type"] = Storage[stated] if stated in names else Storage.scanlineimage
    for name in ("channels", "compression", "dataWindow", "displayWindow"):
        if name not in header:
            raise FileFormatError(f"its header has no {name}")
    return header, start + 1


def _read_text(data: bytes, start: int) -> tuple[str, int]:
    """Return a text that ends in a zero byte, and where the next thing starts."""
    end = data.index(b"\0", start)
    return data[start:end].decode("utf8", "replace"), end + 1


def _parse_attribute(kind: str, raw: bytes) -> Any:
    """Return the value of an attribute; one of another type stays bytes."""
    if kind == "string":
        return raw.decode("utf8", "replace")
    if kind == "compression":
        return Compression(raw[0])
    if kind == "box2i":
        corners = np.array(WINDOW.unpack(raw), np.int32)
        return corners[:2], corners[2:]
    if kind == "chlist":
        return _parse_channels(raw)
    if kind in NUMBER_FORMATS:
        numbers = struct.unpack(NUMBER_FORMATS[kind], raw)
        return numbers[0] if len(numbers) == 1 else numbers
    return raw


def _parse_channels(raw: bytes) -> list[Channel]:
    """Return the channels that a header lists."""
    channels = []
    start = 0
    while raw[start] != 0:
        name, start = _read_text(raw, start)
        pixel_type, _, x_step, y_step = CHANNEL.unpack_from(raw, start)
        channels.append(Channel(name, PIXEL_DTYPES[pixel_type], x_step, y_step))
        start += CHANNEL.size
    return channels


def _shape(header: dict[str, Any]) -> tuple[int, int]:
    """Return the height and the width of the data window."""
    (left, top), (right, bottom) = (corner.tolist() for corner in header["dataWindow"])
    if right < left or bottom < top:
        raise FileFormatError("its data window is empty")
    return bottom - top + 1, right - left + 1


def _count_chunks(header: dict[str, Any]) -> int:
    """Return how many chunks a part has; refuse kinds of pixels that need the official module."""
    if header["type"] != Storage.scanlineimage:
        raise FileFormatError("tiles and deep data need the module OpenEXR: pip install OpenEXR")
    rows = ROWS_PER_CHUNK.get(header["compression"])
    if rows is None:
        method = header["compression"].name.removesuffix("_COMPRESSION")
        raise FileFormatError(f"{method} needs the module OpenEXR: pip install OpenEXR")
    height, _ = _shape(header)
    return -(-height // rows)


def _read_planes(
    data: bytes, header: dict[str, Any], offsets: Sequence[int], is_multi_part: bool
) -> dict[str, Array]:
    """Return the pixels (H, W) of each channel, in the type that they are stored in."""
    channels = header["channels"]
    height, width = _shape(header)
    top = int(header["dataWindow"][0][1])
    row_bytes = width * sum(np.dtype(channel.dtype).itemsize for channel in channels)
    planes = {channel.name: np.empty((height, width), channel.dtype) for channel in channels}
    seen_rows = 0
    for offset in offsets:
        if is_multi_part:
            offset += INTEGER.size  # the number of the part
        y, size = struct.unpack_from("<ii", data, offset)
        start = offset + 2 * INTEGER.size
        first = y - top
        rows = min(ROWS_PER_CHUNK[header["compression"]], height - first)
        if first < 0 or rows <= 0 or not 0 <= size <= len(data) - start:
            raise FileFormatError("a chunk lies outside of the image or of the file")
        block = _decompress(data[start : start + size], rows * row_bytes)
        table = np.frombuffer(block, np.uint8).reshape(rows, row_bytes)
        column = 0
        for channel in channels:
            channel_bytes = width * np.dtype(channel.dtype).itemsize
            pixels = np.ascontiguousarray(table[:, column : column + channel_bytes])
            planes[channel.name][first : first + rows] = pixels.view(channel.dtype)
            column += channel_bytes
        seen_rows += rows
    if seen_rows < height:
        raise FileFormatError("rows are missing")
    return planes


def _decompress(chunk: bytes, size: int) -> bytes:
    """Return the bytes of a chunk, which have this size: undo zlib, differences, and order.

    >>> _decompress(_compress(bytes(range(50))), 50) == bytes(range(50))
    True
    """
    if len(chunk) == size:  # it was stored as it is
        return chunk
    unzipped = zlib.decompressobj().decompress(chunk, size)
    if len(unzipped) != size:
        raise FileFormatError("a chunk is damaged or cut short")
    differences = np.frombuffer(unzipped, np.uint8).copy()
    differences[1:] -= 128  # modulo 256, as the sums
    ordered = np.cumsum(differences, dtype=np.uint8)
    interleaved = np.empty_like(ordered)
    even_count = (size + 1) // 2
    interleaved[::2] = ordered[:even_count]
    interleaved[1::2] = ordered[even_count:]
    return interleaved.tobytes()


def _compress(block: bytes) -> bytes:
    """Return a chunk of these bytes: even bytes first, differences, zlib."""
    interleaved = np.frombuffer(block, np.uint8)
    ordered = np.concatenate([interleaved[::2], interleaved[1::2]])
    differences = ordered.copy()
    differences[1:] -= ordered[:-1]
    differences[1:] += 128
    zipped = zlib.compress(differences.tobytes())
    return zipped if len(zipped) < len(block) else block


def encode_parts(parts: Sequence[NewPart]) -> bytes:
    """Return a file of scan lines, compressed by ZIP, that holds the parts."""
    is_multi_part = len(parts) > 1
    version = VERSION | (MULTI_PART_FLAG if is_multi_part else 0)
    head = MAGIC_AND_VERSION.pack(MAGIC, version)
    chunks_of_parts = [_encode_chunks(part) for part in parts]
    for part, chunks in zip(parts, chunks_of_parts, strict=True):
        head += _encode_header(part, len(chunks), is_multi_part)
    if is_multi_part:
        head += b"\0"
    offset = len(head) + OFFSET_BYTES * sum(len(chunks) for chunks in chunks_of_parts)
    offsets = []
    body = []
    for number, chunks in enumerate(chunks_of_parts):
        for chunk in chunks:
            whole = INTEGER.pack(number) + chunk if is_multi_part else chunk
            offsets.append(offset)
            body.append(whole)
            offset += len(whole)
    return head + np.array(offsets, "<u8").tobytes() + b"".join(body)


def _encode_chunks(part: NewPart) -> list[bytes]:
    """Return the chunks of a part, each with its first row and its size."""
    planes = [part.planes[name] for name in sorted(part.planes)]
    height = len(planes[0])
    chunks = []
    for y in range(0, height, ZIP_ROWS):
        bands = [np.ascontiguousarray(plane[y : y + ZIP_ROWS]) for plane in planes]
        little_endian = [band.astype(band.dtype.newbyteorder("<"), copy=False) for band in bands]
        block = np.concatenate([band.view(np.uint8) for band in little_endian], axis=1).tobytes()
        data = _compress(block)
        chunks.append(struct.pack("<ii", y, len(data)) + data)
    return chunks


def _encode_header(part: NewPart, chunk_count: int, is_multi_part: bool) -> bytes:
    """Return the header of a part."""
    names = sorted(part.planes)
    height, width = part.planes[names[0]].shape
    window = WINDOW.pack(0, 0, width - 1, height - 1)
    channel_list = b""
    for name in names:
        pixel_type = PIXEL_TYPES[part.planes[name].dtype.name]
        channel_list += name.encode() + b"\0" + CHANNEL.pack(pixel_type, 0, 1, 1)
    attributes = [
        ("channels", "chlist", channel_list + b"\0"),
        ("compression", "compression", bytes([Compression.ZIP_COMPRESSION])),
        ("dataWindow", "box2i", window),
        ("displayWindow", "box2i", window),
        ("lineOrder", "lineOrder", b"\0"),
        ("pixelAspectRatio", "float", struct.pack("<f", 1.0)),
        ("screenWindowCenter", "v2f", struct.pack("<2f", 0.0, 0.0)),
        ("screenWindowWidth", "float", struct.pack("<f", 1.0)),
    ]
    if is_multi_part or part.name:
        attributes.append(("name", "string", part.name.encode()))
    if is_multi_part:
        attributes.append(("type", "string", b"scanlineimage"))
        attributes.append(("chunkCount", "int", INTEGER.pack(chunk_count)))
    for name, value in part.attributes.items():
        if isinstance(value, str):
            attributes.append((name, "string", value.encode()))
        else:
            attributes.append((name, "float", struct.pack("<f", value)))
    encoded = b""
    for name, kind, raw in attributes:
        encoded += name.encode() + b"\0" + kind.encode() + b"\0" + INTEGER.pack(len(raw)) + raw
    return encoded + b"\0"
