"""What a JPEG XL says before its pixels: size, samples, colours, frames [ISO 18181-1 annexes D and F].

A file is a codestream, or boxes of which one holds it, or several its parts. A header is bits, the
lowest of each byte first. Colours are those of sRGB, whatever their curve, but that floats are
linear, or those of Display P3; others are refused, as are alpha and animations. Of a frame libjxl
believes any size, so that a few hundred bytes keep it busy for hours: a picture is read that is one
frame of its own size.
"""

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from hdrlab.core.optional import imagecodecs
from hdrlab.errors import InputError
from hdrlab.io.files import OtherPixels

USUAL = 0b110010000
ENOUGH, LONGEST_EXIF = 64, 1 << 16  # bytes for the headers
WIDER = ((1, 1), (6, 5), (4, 3), (3, 2), (16, 9), (5, 4), (2, 1))  # width over height, by number
# bits of a sample: how they are told of whole numbers and of floats, and which are read
DEPTHS = ((8, 0), (10, 0), (12, 0), (1, 6)), ((32, 0), (16, 0), (24, 0), (1, 6))
READ = range(8, 17), (16, 32)
# curves by their number [ITU-T H.273]
LINEAR, SRGB, PQ, HLG = 8, 13, 16, 18
OF_SRGB, OF_P3 = 1, 11  # primaries


class Bits:
    """The bits of a header, to be taken one after the other."""

    def __init__(self, data: bytes) -> None:
        self.left, self.at = int.from_bytes(data, "little"), 0

    def take(self, count: int) -> int:
        """Return a number of so many bits."""
        self.left, value = divmod(self.left, 1 << count)
        self.at += count
        return value

    def pick(self, *ways: tuple[int, int]) -> int:
        """Return a number that is told in one of four ways: from where on, and in how many bits."""
        start, count = ways[self.take(2)]
        return start + self.take(count)

    def kind(self) -> int:
        """Return the number of a colour space, a white, primaries or a curve."""
        return self.pick((0, 0), (1, 0), (2, 4), (18, 6))

    def side(self, small: int) -> int:
        """Return height or width."""
        return 8 + 8 * self.take(5) if small else self.pick((1, 9), (1, 13), (1, 18), (1, 30))

    def size(self) -> tuple[int, int]:
        """Return height and width."""
        small = self.take(1)
        height, ratio = self.side(small), self.take(3)
        over, under = WIDER[ratio - 1]
        return height, height * over // under if ratio else self.side(small)

    def colours(self) -> tuple[int, int, int]:
        """Return the number of the primaries or 0, whether there is gray alone, and the curve's number."""
        if self.take(1):
            return OF_SRGB, 0, SRGB
        profile, gray, white = self.take(1), self.kind(), self.kind()
        primaries = OF_SRGB if gray == 1 else self.kind()
        curve = 0 * self.take(24) if self.take(1) else self.kind()
        self.kind()  # how it is to be rendered
        return primaries if not profile and gray < 2 and white == 1 else 0, gray, curve

    def lone(self, xyb: int) -> bool:
        """Return whether the frame that begins here is the only one, and has the picture's size."""
        self.take(-self.at % 8)
        if self.take(1):  # all is as usual
            return True
        regular, modular, _ = (
            not self.take(2),
            self.take(1),
            self.pick((0, 0), (1, 4), (17, 8), (0, 12)),
        )
        if not xyb and self.take(1):
            self.take(6)  # how YCbCr is sampled
        self.take(2 + (2 if modular else 6 * xyb))
        if (passes := self.pick((1, 0), (2, 0), (3, 0), (4, 3))) > 1:
            smaller = self.pick((0, 0), (1, 0), (2, 0), (3, 1))
            self.take(2 * (passes - 1 + smaller))
            for _ in range(smaller):
                self.pick((0, 0), (1, 0), (2, 0), (0, 3))
        placed, blended, last = self.take(1), self.take(2), self.take(1)
        return bool(regular and last and not (placed or blended))


def boxes(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Yield the name of each box, and what is in it."""
    at = 0
    while at + 8 <= len(data):
        size, name = struct.unpack_from(">I4s", data, at)
        yield name, data[at + 8 : at + (size or len(data))]
        at += size if size >= 8 else len(data)


def codestream(data: bytes) -> bytes:
    """Return the first bytes of the codestream, which is all of the file or stands in boxes."""
    start = {b"jxlc": 0, b"jxlp": 4}
    parts = (box[start[name] :][:ENOUGH] for name, box in boxes(data) if name in start)
    return data if data[:1] == b"\xff" else b"".join(parts)


def exif(data: bytes) -> bytes:
    """Return EXIF, which may be packed by Brotli, or nothing."""
    for name, box in boxes(data):
        if name == b"brob" and box[:4] == b"Exif":
            name, box = (
                b"Exif",
                bytes(imagecodecs.brotli_decode(box[4:], out=bytearray(LONGEST_EXIF))),
            )
        if name == b"Exif":
            return box[4:]
    return b""


def look(
    path: str | Path, head: bytes
) -> tuple[tuple[int, ...], np.dtype[Any], int, int, int, int]:
    """Return shape, dtype and bits of the samples as they are stored, orientation, curve and primaries.

    `head` is the beginning of the file. What is not read is an `OtherPixels`.
    """
    data = codestream(head)
    if not data:
        raise InputError(
            f"{path}: expected a photograph, its header is damaged (it has no codestream)"
        )
    bits, orientation = Bits(data[2:ENOUGH]), 1
    size = bits.size()
    if bits.take(1):  # all is as usual, as 11 bits would say
        bits.left, bits.at = bits.left << 11 | USUAL, bits.at - 11
    if more := bits.take(1):
        orientation += bits.take(3)
        if bits.take(1):
            bits.size()  # on a page
        if bits.take(2):
            raise OtherPixels(
                f"{path}: expected one picture, got an animation or a preview as well"
            )
    floats = bits.take(1)
    depth, _ = (
        bits.pick(*DEPTHS[floats]),
        bits.take(4 * floats + 1),
    )  # an exponent's bits, and the decoder's
    others, xyb = bits.pick((0, 0), (1, 0), (2, 4), (1, 12)), bits.take(1)
    if others or depth not in READ[floats]:
        got = f"{depth} bits and {others} more channels"
        raise OtherPixels(f"{path}: expected gray or RGB of 8 or 16 bits, got {got}")
    primaries, gray, curve = bits.colours()
    if primaries != OF_SRGB and (primaries, curve, floats) != (OF_P3, SRGB, 0):
        raise OtherPixels(
            f"{path}: expected the primaries of sRGB or Display P3, got others or a profile"
        )
    if floats and curve != LINEAR:
        raise OtherPixels(f"{path}: expected floats that are linear, got the curve number {curve}")
    if more and not bits.take(1):
        bits.take(49)  # how bright it is meant to be
    if bits.take(2) or not bits.take(1) or not bits.lone(xyb):  # extensions, the usual transforms
        raise OtherPixels(
            f"{path}: expected one frame of the picture's size, got several or another"
        )
    dtype = np.dtype(f"{'uf'[floats]}{(depth + 7) // 8}")
    return (*size, 3)[: 3 - gray], dtype, depth, orientation, curve, primaries
