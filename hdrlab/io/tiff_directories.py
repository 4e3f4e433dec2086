"""Directories of TIFF tags, which hold the EXIF of every photo format.

A TIFF block is a header, which names the byte order, and directories of entries. An entry is a tag,
a type, a count and a value; a value of more than 4 bytes is stored elsewhere in the block. EXIF is
such a block: its first directory describes the image, and points to one directory with the
camera's settings and to another with the position.
"""

import struct
from collections.abc import Iterator
from dataclasses import dataclass

from PIL.ExifTags import IFD, Base

from hdrlab.errors import FileFormatError

# The first four bytes of TIFF, of Olympus' ORF (three variants) and of Panasonic's RW2.
BYTE_ORDERS = {
    b"II*\0": "<",
    b"MM\0*": ">",
    b"IIRO": "<",
    b"IIRS": "<",
    b"MMOR": ">",
    b"IIU\0": "<",
}
# Bytes of one value, by the type of the entry.
VALUE_SIZES = {
    1: 1,  # BYTE
    2: 1,  # ASCII
    3: 2,  # SHORT
    4: 4,  # LONG
    5: 8,  # RATIONAL
    6: 1,  # SBYTE
    7: 1,  # UNDEFINED
    8: 2,  # SSHORT
    9: 4,  # SLONG
    10: 8,  # SRATIONAL
    11: 4,  # FLOAT
    12: 8,  # DOUBLE
    13: 4,  # IFD
}
ENTRY_SIZE = 12
POINTER_TYPES = (4, 13)
# Directories of EXIF have no successor, and some cameras leave noise where its offset would be.
EXIF_DIRECTORY_TAGS = (IFD.Exif, IFD.GPSInfo, IFD.Interop)
# A file with more directories than this is refused, not cleaned in part.
MAX_DIRECTORIES = 4096


@dataclass(frozen=True)
class Entry:
    """One entry of a directory, with the offsets of its value and of its own 12 bytes."""

    tag: int
    type: int
    value: bytes
    value_offset: int
    offset: int


@dataclass(frozen=True)
class Directory:
    """The entries of one directory; `next_offset` is 0 where no other directory follows.

    `found_by_tag` is the tag whose entry points here, None for a page of the file.
    """

    offset: int
    entries: tuple[Entry, ...]
    next_offset: int
    found_by_tag: int | None = None

    @property
    def is_gps(self) -> bool:
        """Whether this is EXIF's directory of the position."""
        return self.found_by_tag == IFD.GPSInfo

    @property
    def tags(self) -> set[int]:
        """The tags of all entries."""
        return {entry.tag for entry in self.entries}

    @property
    def end(self) -> int:
        """The offset behind the directory, without the values that are stored elsewhere."""
        return self.offset + 2 + ENTRY_SIZE * len(self.entries) + 4


def read_byte_order(block: bytes | bytearray) -> str:
    """Return the byte order of a TIFF block as `struct` spells it: "<" or ">".

    Raises
    ------
    FileFormatError
        For a block that does not begin as TIFF does.
    """
    byte_order = BYTE_ORDERS.get(bytes(block[:4]))
    if byte_order is None or len(block) < 8:
        raise FileFormatError("this is no TIFF or EXIF block")
    return byte_order


def read_directory(
    block: bytes | bytearray, offset: int, *, found_by_tag: int | None = None
) -> Directory:
    """Return the directory at an offset of a TIFF block.

    An entry of an unknown type, and one whose value lies outside the block, has an empty value.

    Raises
    ------
    FileFormatError
        For a directory that does not fit into the block.
    """
    byte_order = read_byte_order(block)
    if offset < 8 or offset + 6 > len(block):
        raise FileFormatError(f"its TIFF directory at byte {offset} lies outside the file")
    (count,) = struct.unpack_from(f"{byte_order}H", block, offset)
    next_pointer = offset + 2 + ENTRY_SIZE * count
    if next_pointer + 4 > len(block):
        raise FileFormatError(f"its TIFF directory at byte {offset} is cut short")
    entries = []
    # Values that overlap could multiply to any amount of memory, so their sum is limited.
    bytes_left = len(block)
    for entry_offset in range(offset + 2, next_pointer, ENTRY_SIZE):
        tag, value_type, length = struct.unpack_from(f"{byte_order}HHL", block, entry_offset)
        size = VALUE_SIZES.get(value_type, 0) * length
        value_offset = entry_offset + 8
        if size > 4:
            (value_offset,) = struct.unpack_from(f"{byte_order}L", block, entry_offset + 8)
        bytes_left -= size
        value = b""
        if value_offset + size <= len(block) and bytes_left >= 0:
            value = bytes(block[value_offset : value_offset + size])
        entries.append(Entry(tag, value_type, value, value_offset, entry_offset))
    (next_offset,) = struct.unpack_from(f"{byte_order}L", block, next_pointer)
    return Directory(offset, tuple(entries), next_offset, found_by_tag)


def read_first_directory(block: bytes | bytearray) -> Directory:
    """Return the first directory of a TIFF block."""
    (offset,) = struct.unpack_from(f"{read_byte_order(block)}L", block, 4)
    return read_directory(block, offset)


def read_pointers(block: bytes | bytearray, directory: Directory, tag: int) -> list[int]:
    """Return the offsets of the directories to which the entry with a tag points."""
    byte_order = read_byte_order(block)
    offsets: list[int] = []
    for entry in directory.entries:
        if entry.tag == tag and entry.type in POINTER_TYPES:
            number = len(entry.value) // 4
            offsets += struct.unpack(f"{byte_order}{number}L", entry.value)
    return offsets


def iter_directories(block: bytes | bytearray) -> Iterator[Directory]:
    """Yield every directory of a TIFF block: those of all pages, and all below these.

    Raises
    ------
    FileFormatError
        For a damaged directory, and for more than MAX_DIRECTORIES.
    """
    waiting = [read_first_directory(block)]
    seen = {waiting[0].offset}
    while waiting:
        directory = waiting.pop()
        yield directory
        for offset, tag in _successors(block, directory):
            if offset in seen:
                continue
            if len(seen) >= MAX_DIRECTORIES:
                raise FileFormatError(f"it has more than {MAX_DIRECTORIES} TIFF directories")
            seen.add(offset)
            waiting.append(read_directory(block, offset, found_by_tag=tag))


def _successors(block: bytes | bytearray, directory: Directory) -> list[tuple[int, int | None]]:
    """Return the offsets of the directories that follow one, each with the tag that points to it."""
    successors: list[tuple[int, int | None]] = []
    if directory.next_offset and directory.found_by_tag not in EXIF_DIRECTORY_TAGS:
        successors.append((directory.next_offset, directory.found_by_tag))
    for tag in (Base.SubIFDs, *EXIF_DIRECTORY_TAGS):
        successors += [(offset, tag) for offset in read_pointers(block, directory, tag)]
    return successors


def write_entries(
    out: bytearray, directory: Directory, kept: list[Entry], next_offset: int, byte_order: str
) -> None:
    """Overwrite a directory in `out` with some of its entries; what is left of it becomes zero."""
    cells = [bytes(out[entry.offset : entry.offset + ENTRY_SIZE]) for entry in kept]
    table = struct.pack(f"{byte_order}H", len(cells)) + b"".join(cells)
    table += struct.pack(f"{byte_order}L", next_offset)
    out[directory.offset : directory.end] = table.ljust(directory.end - directory.offset, b"\0")


def blank_value(out: bytearray, entry: Entry) -> None:
    """Overwrite the value of an entry with zeros."""
    out[entry.value_offset : entry.value_offset + len(entry.value)] = bytes(len(entry.value))
