"""Check the members of an archive: plain files with plain names, of sizes that a submission needs."""

import os
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import IO, NamedTuple

from hdrlab.course.sanitize import sanitize_line
from hdrlab.errors import InputError

PORT_NUMBERS = range(1, 10)
# Windows opens a device for a file of such a name, whatever its extension
DEVICE_NAMES = {
    "con",
    "prn",
    "aux",
    "nul",
    *(f"com{number}" for number in PORT_NUMBERS),
    *(f"lpt{number}" for number in PORT_NUMBERS),
}
# Unicode categories of control characters, of invisible format characters, and of half characters
CONTROL_CATEGORIES = ("Cc", "Cf", "Cs")
# read at a time
CHUNK_BYTES = 64 * 2**10
# archives that unpack to less may have any compression ratio
MIN_CHECKED_RATIO_BYTES = 2**20
MAX_SHOWN_NAME_CHARACTERS = 60


class ArchiveRejected(InputError):
    """Raised if an archive is not unpacked; the message says why, in one line."""


@dataclass(frozen=True, kw_only=True)
class ArchiveLimits:
    """How much an archive may hold."""

    max_members: int = 2000
    max_total_bytes: int = 2**30
    max_file_bytes: int = 2**29
    # how many parts a path may have
    max_depth: int = 12
    # of a path, in UTF-8
    max_name_bytes: int = 200
    max_compression_ratio: int = 200


class Member(NamedTuple):
    """A file of an archive: its path inside, and the size that the archive claims."""

    path: PurePosixPath
    size: int


LIMITS = ArchiveLimits()


def check_names(names: Sequence[str], limits: ArchiveLimits = LIMITS) -> list[PurePosixPath]:
    """Return the names of files as paths inside a folder, or raise ArchiveRejected.

    A name is rejected if it leads out of the folder, if it is not a plain name on every system, or
    if it is the same file or folder as another name on some system.

    Examples
    --------
    >>> check_names(["report.html", "photographs/a.jpg"])[1].parts
    ('photographs', 'a.jpg')
    >>> check_names(["../x"])
    Traceback (most recent call last):
    hdrlab.course.submissions.archives.members.ArchiveRejected: '../x' leads out of the archive's folder
    """
    check_count(len(names), limits)
    paths = [_check_name(name, limits) for name in names]
    # by normalized path: whether it is a file, or a folder
    is_file_by_path: dict[str, bool] = {}
    for path in paths:
        # without the last parent, which is the folder that all paths are relative to
        folders = list(path.parents)[:-1]
        for folder in folders:
            key = _normalize(folder)
            # two files may share a folder
            if is_file_by_path.get(key, False):
                raise _duplicate_name(path)
            is_file_by_path[key] = False
        key = _normalize(path)
        if key in is_file_by_path:
            raise _duplicate_name(path)
        is_file_by_path[key] = True
    return paths


def _normalize(path: PurePosixPath) -> str:
    """Return a text that is the same for paths that are one file on some system."""
    return unicodedata.normalize("NFC", str(path)).casefold()


def _duplicate_name(path: PurePosixPath) -> ArchiveRejected:
    """Return the error for a path that is there twice."""
    name = quote_name(str(path))
    return ArchiveRejected(f"{name} is there twice, or differs from another by case")


def _check_name(name: str, limits: ArchiveLimits) -> PurePosixPath:
    """Return a name as a path of plain parts, or raise ArchiveRejected."""
    quoted = quote_name(name)
    path = PurePosixPath(name)
    has_drive = name[1:2] == ":"
    if name.startswith(("/", "\\")) or has_drive:
        raise ArchiveRejected(f"{quoted} is an absolute name")
    if ".." in name.replace("\\", "/").split("/"):
        raise ArchiveRejected(f"{quoted} leads out of the archive's folder")
    has_control_character = any(
        unicodedata.category(character) in CONTROL_CATEGORIES for character in name
    )
    if "\\" in name or has_control_character:
        raise ArchiveRejected(f"{quoted} has a backslash or a control character in its name")
    is_too_long = len(name.encode()) > limits.max_name_bytes
    is_too_deep = len(path.parts) > limits.max_depth
    if not path.parts or is_too_long or is_too_deep:
        raise ArchiveRejected(f"{quoted} is empty, too long, or too deep")
    for part in path.parts:
        is_device = part.split(".")[0].casefold() in DEVICE_NAMES
        # Windows drops a dot or a space at the end, and a colon begins the name of a stream
        if is_device or part.endswith((".", " ")) or ":" in part:
            raise ArchiveRejected(f"{quoted} is not a plain file name on every system")
    return path


def quote_name(name: str) -> str:
    """Return a member's name in quotes, shortened and without control characters, for a message."""
    # "replace", because a name may contain half characters
    encodable = name.encode("utf8", "replace").decode("utf8")
    return repr(sanitize_line(encodable, MAX_SHOWN_NAME_CHARACTERS))


def check_count(count: int, limits: ArchiveLimits) -> None:
    """Raise ArchiveRejected if there are too many members."""
    if count > limits.max_members:
        raise ArchiveRejected(f"it has {count} members, expected at most {limits.max_members}")


def check_sizes(members: Sequence[Member], packed_bytes: int, limits: ArchiveLimits) -> None:
    """Raise ArchiveRejected if claimed sizes are too large.

    Parameters
    ----------
    members : sequence of Member
        The files of the archive.
    packed_bytes : int
        The size of the archive itself.
    limits : ArchiveLimits
        How large one file and all files may be, and how many times larger than the archive.
    """
    for path, size in members:
        if size > limits.max_file_bytes:
            name = quote_name(str(path))
            raise ArchiveRejected(
                f"{name} claims {size} bytes, expected at most {limits.max_file_bytes}"
            )
    total = sum(size for _, size in members)
    if total > limits.max_total_bytes:
        raise ArchiveRejected(
            f"its files claim {total} bytes together, expected at most {limits.max_total_bytes}"
        )
    max_unpacked_bytes = limits.max_compression_ratio * packed_bytes
    if total > MIN_CHECKED_RATIO_BYTES and total > max_unpacked_bytes:
        ratio = total // max(packed_bytes, 1)
        raise ArchiveRejected(
            f"it unpacks to {ratio} times its size, expected at most {limits.max_compression_ratio}"
        )


def write_member(source: IO[bytes], path: Path, size: int) -> None:
    """Write a member into a new file, without the permissions and times that the archive gives.

    Parameters
    ----------
    source : file
        The content of the member.
    path : Path
        The file to create. It must not exist.
    size : int
        The size that the archive claims. ArchiveRejected is raised if the content is larger or
        smaller; no more than one byte beyond the size is read.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    # fails if the file exists, and follows no link
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL
    # not every system has these two
    flags |= getattr(os, "O_NOFOLLOW", 0)
    flags |= getattr(os, "O_BINARY", 0)
    bytes_left = size
    with os.fdopen(os.open(path, flags, 0o644), "wb") as file:
        while chunk := source.read(min(CHUNK_BYTES, bytes_left + 1)):
            bytes_left -= len(chunk)
            if bytes_left < 0:
                name = quote_name(path.name)
                raise ArchiveRejected(f"{name} is larger than the {size} bytes it claims")
            file.write(chunk)
    if bytes_left > 0:
        name = quote_name(path.name)
        raise ArchiveRejected(f"{name} is shorter than the {size} bytes it claims")
