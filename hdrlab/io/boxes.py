"""Boxes of the ISO base media file format: HEIC, AVIF, Canon's CR3 and the JPEG XL container.

A box is a length (4 bytes), a type (4 bytes) and its content. A length of 1 means that the real
length follows in 8 bytes; a length of 0 means that the box reaches to the end of the file.
"""

import struct
from collections.abc import Iterator
from dataclasses import dataclass

from hdrlab.errors import FileFormatError

LENGTH_IN_NEXT_8_BYTES = 1


@dataclass(frozen=True)
class Box:
    """One box: its type and the offsets of its header, of its content and of its end."""

    type: bytes
    start: int
    content_start: int
    end: int


def iter_boxes(data: bytes | bytearray, start: int = 0, end: int | None = None) -> Iterator[Box]:
    """Yield the boxes between two offsets, in their order.

    A box that claims to reach beyond `end` is cut there.

    Raises
    ------
    FileFormatError
        For a box that is shorter than its own header.
    """
    end = len(data) if end is None else end
    while start + 8 <= end:
        length, box_type = struct.unpack_from(">I4s", data, start)
        header_length = 8
        if length == LENGTH_IN_NEXT_8_BYTES and start + 16 <= end:
            (length,) = struct.unpack_from(">Q", data, start + 8)
            header_length = 16
        if length == 0:
            length = end - start
        if length < header_length:
            raise FileFormatError(f"the box {box_type!r} claims a length of {length} bytes")
        box_end = min(start + length, end)
        yield Box(box_type, start, start + header_length, box_end)
        start = box_end
