"""What a photograph says of its exposure, kept; where it was taken and by which very camera, left out.

EXIF is a small TIFF file: directories of entries (tag, type, count, value), of which the first
names the one of the camera's settings. It is written anew from the entries on a list, so that what
nobody thought of is left out as well: positions, serial numbers, owners, notes that only the maker
can read, a small picture.
"""

import struct
import tomllib
from pathlib import Path
from typing import Any, NamedTuple

from hdrlab.errors import InputError

TAGS: dict[str, Any] = tomllib.loads(Path(__file__).with_name("exif.toml").read_text("utf8"))
POINTER, POSITION, NOTES = TAGS["pointer"], TAGS["position"], TAGS["notes"]
PERSONAL, SERIALS, OTHERS = TAGS["personal"], TAGS["serials"], TAGS["others"]


class Entry(NamedTuple):
    """An entry of a directory: `value` is its bytes, and `at` where they are in the file."""

    tag: int
    type: int
    length: int
    value: bytes
    at: int


def order(block: bytes) -> str:
    """Return "<" or ">" as the file says, or raise a ValueError."""
    found = {b"II*\0": "<", b"MM\0*": ">"}.get(bytes(block[:4]))
    if found is None or len(block) < 8:
        raise InputError("expected EXIF or TIFF, its first bytes are others")
    return found


def directory(block: bytes, at: int, sign: str) -> tuple[list[Entry], int]:
    """Return the entries of the directory at a place, and the place of the next one; 0 is none."""
    if at < 8 or at + 6 > len(block):
        raise InputError("expected a directory within the file")
    (count,) = struct.unpack_from(f"{sign}H", block, at)
    if at + 6 + 12 * count > len(block):
        raise InputError("expected the entries of a directory within the file")
    entries, left = [], len(block)  # bytes: values that lie over each other would fill any memory
    for k in range(count):
        place = at + 2 + 12 * k
        tag, kind, length = struct.unpack_from(f"{sign}HHL", block, place)
        size = TAGS["sizes"].get(str(kind), 0) * length
        start = place + 8 if size <= 4 else struct.unpack_from(f"{sign}L", block, place + 8)[0]
        left -= size
        if size and start + size <= len(block) and left >= 0:
            entries.append(Entry(tag, kind, length, bytes(block[start : start + size]), start))
    return entries, struct.unpack_from(f"{sign}L", block, at + 2 + 12 * count)[0]


def first(block: bytes) -> int:
    """Return the place of a file's first directory."""
    return int(struct.unpack_from(f"{order(block)}L", block, 4)[0])


def pointed(block: bytes, entries: list[Entry], tag: int = POINTER) -> list[Entry]:
    """Return the directory that an entry points to; an empty one where there is none."""
    sign = order(block)
    for entry in entries:
        if entry.tag == tag and entry.type == 4:
            return directory(block, struct.unpack(f"{sign}L", entry.value[:4])[0], sign)[0]
    return []


def list_personal_data(block: bytes) -> set[str]:
    """Return what a file tells beyond its exposure, in words."""
    entries, following = directory(block, first(block), order(block))
    settings = pointed(block, entries)
    tags = {entry.tag for entry in [*entries, *settings]}
    told = {name for name, tag in PERSONAL.items() if tag in tags}
    told |= {"location"} if POSITION in tags else set()
    told |= {"serial numbers"} if tags & {*SERIALS} else set()
    told |= {"notes of the maker"} if NOTES in tags else set()
    return told | ({"a small picture"} if following else set())


def cleaned(block: bytes) -> bytes:
    """Return EXIF with the entries of the lists alone.

    Raises
    ------
    ValueError
        For a block that is none, or is damaged.
    """
    sign = order(block)
    entries, _ = directory(block, first(block), sign)
    kept = [entry for entry in entries if entry.tag in TAGS["kept"]]
    settings = [entry for entry in pointed(block, entries) if entry.tag in TAGS["settings"]]
    start = 8 + 2 + 12 * (len(kept) + bool(settings)) + 4
    spill = sum(len(one.value) + len(one.value) % 2 for one in kept if len(one.value) > 4)
    if settings:
        kept.append(Entry(POINTER, 4, 1, struct.pack(f"{sign}L", start + spill), 0))
    head, body = bytes(block[:4]) + struct.pack(f"{sign}L", 8), _written(sorted(kept), 8, sign)
    return head + body + (_written(sorted(settings), 8 + len(body), sign) if settings else b"")


def _written(entries: list[Entry], at: int, sign: str) -> bytes:
    """Return a directory that stands at a place, with its values behind it."""
    table, values = struct.pack(f"{sign}H", len(entries)), b""
    behind = at + 2 + 12 * len(entries) + 4
    for tag, kind, count, value, _ in entries:
        if len(value) <= 4:
            cell = value.ljust(4, b"\0")
        else:
            cell = struct.pack(f"{sign}L", behind + len(values))
            values += value + b"\0" * (len(value) % 2)
        table += struct.pack(f"{sign}HHL", tag, kind, count) + cell
    return table + bytes(4) + values
