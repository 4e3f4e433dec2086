"""Photographs without where they were taken and which camera took them, their pixels untouched to the bit.

The coded pixels of JPEG and PNG are copied; EXIF is written anew (see `exif`), a colour profile
stays, and everything else that programs add is left out. In TIFF and in RAW files, whose parts
point at each other, what tells is blanked where it stands. A RAW file needs its maker's notes, in
which a serial number may stand.
"""

import struct
import zlib
from pathlib import Path
from typing import NamedTuple

from hdrlab.course.projects import exif
from hdrlab.course.projects.project import FILES
from hdrlab.errors import InputError
from hdrlab.io.codecs import jpeg_parts

PICTURES, TIFF_LIKE, PLAIN_CHUNKS = (
    {*FILES["cleaned"][one]} for one in ("pictures", "raw", "chunks")
)
SIGNATURE = b"\x89PNG\r\n\x1a\n"


class Cleaned(NamedTuple):
    """A file's bytes, what was left out, and what may still tell, in words."""

    data: bytes
    removed: frozenset[str]
    remains: str = ""


def clean(name: str | Path, data: bytes) -> Cleaned:
    """Return a picture without what tells where and by which camera it was taken.

    Raises
    ------
    ValueError
        For a file of a kind that cannot be cleaned, and for one that is damaged.
    """
    suffix = Path(name).suffix.lower()
    try:
        if data[:2] == b"\xff\xd8":
            return _jpeg(data)
        if data[:8] == SIGNATURE:
            return _png(data)
        if data[:4] in (b"II*\0", b"MM\0*") and suffix in PICTURES | TIFF_LIKE:
            return _tiff(data, raw=suffix in TIFF_LIKE)
    except (struct.error, IndexError, ValueError) as error:
        raise InputError(
            f"{name}: expected a picture, it is cut short or damaged ({error})"
        ) from None
    raise InputError(
        f"{name}: expected JPEG, PNG, TIFF, DNG, NEF, ARW, CR2 or PEF, others cannot be cleaned"
    )


def _exif(block: bytes) -> tuple[bytes, set[str]]:
    """Return EXIF cleaned, and what it told; nothing of it where it cannot be read."""
    try:
        return exif.cleaned(block), exif.list_personal_data(block)
    except (ValueError, struct.error):
        return b"", {"EXIF that cannot be read"}


def _jpeg(data: bytes) -> Cleaned:
    out, removed, marker = bytearray(b"\xff\xd8"), set(), 0
    for here, start, end in jpeg_parts(data):
        before, marker, body = marker, here, data[start:end]
        if 0xE0 <= marker <= 0xEF or marker == 0xFE:
            body, told = _application(marker, body)
            removed |= told
            if not body:
                continue
        elif not marker and before != 0xDA and body.strip(b"\xff"):
            raise InputError("expected a marker of JPEG, the file is damaged")
        if marker:
            out += bytes((0xFF, marker)) + (
                b"" if marker == 0xD9 else struct.pack(">H", len(body) + 2)
            )
        out += body
    if end < len(data):
        removed.add("what follows the picture")
    return Cleaned(bytes(out), frozenset(removed))


def _application(marker: int, body: bytes) -> tuple[bytes, set[str]]:
    """Return what stays of a segment that a program added, and what it told."""
    if marker == 0xE1 and body[:6] == b"Exif\0\0":
        kept, told = _exif(body[6:])
        return (b"Exif\0\0" + kept if kept else b""), told
    if (marker, body[:5]) == (0xE0, b"JFIF\0"):
        return body[:14] if len(body) < 14 else body[:12] + bytes(
            2
        ), set()  # without its small picture
    if (marker, body[:5]) == (0xEE, b"Adobe") or (marker, body[:12]) == (0xE2, b"ICC_PROFILE\0"):
        return body, set()
    if b"GPS" in body:
        return b"", {"location"}
    return b"", {"comment" if marker == 0xFE else "what programs added"}


def _png(data: bytes) -> Cleaned:
    out, removed, at, kind = bytearray(SIGNATURE), set(), 8, b""
    while kind != b"IEND":
        length, kind = struct.unpack_from(">L4s", data, at)
        body = data[at + 8 : at + 8 + length]
        if len(body) < length:
            raise InputError("expected all of a PNG, the file is cut short")
        if kind == b"eXIf":
            body, told = _exif(body)
            removed |= told
        elif kind.decode("latin-1") not in PLAIN_CHUNKS:
            removed.add("location" if b"GPS" in body else "what programs added")
            body = b""
        if body or kind == b"IEND":
            out += (
                struct.pack(">L", len(body))
                + kind
                + body
                + struct.pack(">L", zlib.crc32(kind + body))
            )
        at += 12 + length
    if at < len(data):
        removed.add("what follows the picture")
    return Cleaned(bytes(out), frozenset(removed))


def _tiff(data: bytes, *, raw: bool) -> Cleaned:
    out, sign = bytearray(data), exif.order(data)
    gone = {exif.POSITION, *exif.SERIALS, *exif.OTHERS, *exif.PERSONAL.values()}
    gone |= set() if raw else {exif.NOTES}
    at = exif.first(data)
    seen: set[int] = set()
    left = {"notes of the maker", "a small picture"} if raw else {"a small picture"}
    removed = exif.list_personal_data(data) - left
    while at and at not in seen and len(seen) < 64:
        seen.add(at)
        entries, following = exif.directory(data, at, sign)
        for entry in exif.pointed(data, entries, exif.POSITION):
            out[entry.at : entry.at + len(entry.value)] = bytes(len(entry.value))
        _blank(out, at, entries, gone, sign)
        for entry in entries:
            if entry.tag == exif.POINTER:
                place = struct.unpack(f"{sign}L", entry.value[:4])[0]
                _blank(out, place, exif.directory(data, place, sign)[0], gone, sign)
        at = following
    return Cleaned(
        bytes(out), frozenset(removed), "a serial number in its maker's notes" if raw else ""
    )


def _blank(out: bytearray, at: int, entries: list[exif.Entry], gone: set[int], sign: str) -> None:
    """Blank the values of entries in a directory, and take the entries out of it."""
    for entry in entries:
        if entry.tag in gone:
            out[entry.at : entry.at + len(entry.value)] = bytes(len(entry.value))
    (count,) = struct.unpack_from(f"{sign}H", out, at)
    cells = [bytes(out[at + 2 + 12 * k : at + 14 + 12 * k]) for k in range(count)]
    left = [cell for cell in cells if struct.unpack_from(f"{sign}H", cell)[0] not in gone]
    after = bytes(out[at + 2 + 12 * count : at + 6 + 12 * count])
    table = struct.pack(f"{sign}H", len(left)) + b"".join(left) + after
    out[at : at + 6 + 12 * count] = table.ljust(6 + 12 * count, b"\0")
