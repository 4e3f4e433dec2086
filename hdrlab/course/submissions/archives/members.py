"""What the members of an archive may be: plain files with plain names, of sizes that a submission needs."""

import os
import unicodedata
from collections.abc import Sequence
from pathlib import Path, PurePosixPath
from typing import IO, NamedTuple

from hdrlab.course.sanitize import sanitize_line
from hdrlab.errors import InputError

DEVICES = {
    "con",
    "prn",
    "aux",
    "nul",
    *(f"{port}{k}" for port in ("com", "lpt") for k in range(1, 10)),
}
PIECE = 1 << 16  # bytes read at a time


class Refused(InputError):
    """Why an archive is not unpacked, in one line."""


class Limits(NamedTuple):
    """The most that an archive may hold: members, bytes in all and of one, depth, bytes of a name, ratio."""

    members: int = 2000
    total: int = 1 << 30
    one: int = 1 << 29
    depth: int = 12
    name: int = 200
    ratio: int = 200


class Member(NamedTuple):
    """A file of an archive: its path inside, its claimed size."""

    path: PurePosixPath
    size: int


LIMITS = Limits()


def check_names(names: Sequence[str], limits: Limits = LIMITS) -> list[PurePosixPath]:
    """Return the names of files as paths inside a folder, or raise Refused for the first that is none.

    Examples
    --------
    >>> check_names(["report.html", "photographs/a.jpg"])[1].parts
    ('photographs', 'a.jpg')
    >>> check_names(["../../etc/passwd"])
    Traceback (most recent call last):
    hdrlab.course.submissions.archives.members.Refused: '../../etc/passwd' leads out of the archive's folder
    """
    check_count(len(names), limits)
    paths = [_path(name, limits) for name in names]
    kinds: dict[str, bool] = {}  # folded path -> whether it is a file
    for path in paths:
        for part in [*list(path.parents)[:-1], path]:
            key, is_file = unicodedata.normalize("NFC", str(part)).casefold(), part == path
            if key in kinds and (is_file or kinds[key]):
                raise Refused(
                    f"{quote_name(str(path))} is there twice, or differs from another by case"
                )
            kinds[key] = is_file
    return paths


def _path(name: str, limits: Limits) -> PurePosixPath:
    """Return one name as a path of plain parts."""
    shown, path = quote_name(name), PurePosixPath(name)
    if name.startswith(("/", "\\")) or name[1:2] == ":":
        raise Refused(f"{shown} is an absolute name")
    if ".." in name.replace("\\", "/").split("/"):
        raise Refused(f"{shown} leads out of the archive's folder")
    if "\\" in name or any(unicodedata.category(letter) in ("Cc", "Cf", "Cs") for letter in name):
        raise Refused(f"{shown} has a backslash or a control character in its name")
    if not path.parts or len(name.encode()) > limits.name or len(path.parts) > limits.depth:
        raise Refused(f"{shown} is empty, too long, or too deep")
    for part in path.parts:
        if part.split(".")[0].casefold() in DEVICES or part[-1] in ". " or ":" in part:
            raise Refused(f"{shown} is a device's name on some systems")
    return path


def quote_name(name: str) -> str:
    """Return a member's name as a message can show it."""
    return repr(sanitize_line(name.encode("utf8", "replace").decode("utf8"), 60))


def check_sizes(members: Sequence[Member], packed: int, limits: Limits) -> None:
    """Raise Refused where claimed sizes are too large, singly, together, or for the bytes of the archive."""
    for path, size in members:
        if size > limits.one:
            raise Refused(
                f"{quote_name(str(path))} claims {size} bytes, expected at most {limits.one}"
            )
    total = sum(size for _, size in members)
    if total > limits.total:
        raise Refused(f"its files claim {total} bytes together, expected at most {limits.total}")
    if total > (1 << 20) and total > limits.ratio * packed:
        times = total // (packed or 1)
        raise Refused(f"it unpacks to {times} times its size, expected at most {limits.ratio}")


def write(source: IO[bytes], place: Path, size: int) -> None:
    """Write a member of exactly the claimed size into a new file, without its rights and times."""
    place.parent.mkdir(parents=True, exist_ok=True)
    flags = (
        os.O_WRONLY
        | os.O_CREAT
        | os.O_EXCL
        | getattr(os, "O_NOFOLLOW", 0)
        | getattr(os, "O_BINARY", 0)
    )
    with os.fdopen(os.open(place, flags, 0o644), "wb") as file:
        left = size
        while piece := source.read(min(PIECE, left + 1)):
            left -= len(piece)
            if left < 0:
                raise Refused(f"{quote_name(place.name)} is larger than the {size} bytes it claims")
            file.write(piece)
    if left:
        raise Refused(f"{quote_name(place.name)} is shorter than the {size} bytes it claims")


def check_count(count: int, limits: Limits) -> None:
    """Raise Refused for too many members."""
    if count > limits.members:
        raise Refused(f"it has {count} members, expected at most {limits.members}")
