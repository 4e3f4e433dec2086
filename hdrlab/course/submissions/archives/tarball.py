"""Archives of tar, compressed or not, judged before the reader of the standard library sees them."""

import bz2
import gzip
import lzma
import os
import tarfile
import tempfile
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import IO, Any

from hdrlab.course.submissions.archives import members
from hdrlab.course.submissions.archives.members import PIECE, Limits, Member, Refused, quote_name

# by the first bytes of an archive
OPENERS: dict[bytes, Any] = {b"\x1f\x8b": gzip.open, b"BZh": bz2.open, b"\xfd7zXZ\0": lzma.open}
HEADER = 1 << 16  # bytes of a header of tar: a long name, and not a bomb
# types of headers that change what follows: of a member, of all, and Solaris' of a member
PAX = b"xgX"


def unpack(archive: Path, fresh: Path, limits: Limits) -> list[Member]:
    """Write the files of a tar into a folder that is there and empty, and return them."""
    with tempfile.TemporaryFile(dir=fresh.parent) as plain_tar:
        packed = archive.stat().st_size
        _inflate(archive, plain_tar, packed, limits)
        _check_headers(plain_tar, limits)
        plain_tar.seek(0)
        with closing(tarfile.open(fileobj=plain_tar, mode="r:")) as opened:
            infos = [info for info in opened.getmembers() if not info.isdir()]
            for info in infos:
                if not info.isreg() or info.issparse():
                    what = "link" if info.issym() or info.islnk() else "device or a sparse file"
                    raise Refused(f"{quote_name(info.name)} is a {what}, expected plain files")
            paths = members.check_names([info.name for info in infos], limits)
            found = [Member(path, info.size) for path, info in zip(paths, infos, strict=True)]
            members.check_sizes(found, packed, limits)
            for info, member in zip(infos, found, strict=True):
                source = opened.extractfile(info)
                assert source is not None  # a plain file has one
                members.write(source, fresh / member.path, member.size)
    return found


def _inflate(archive: Path, target: IO[bytes], packed: int, limits: Limits) -> None:
    """Write the archive without its compression, up to what the limits allow."""
    with open(archive, "rb") as file:
        magic = file.read(6)
    opener = next((one for start, one in OPENERS.items() if magic.startswith(start)), open)
    most = limits.total + limits.members * 2 * tarfile.BLOCKSIZE + tarfile.RECORDSIZE
    most = min(most, max(limits.ratio * packed, 1 << 20)) if opener is not open else most
    with opener(archive, "rb") as source:
        while piece := source.read(PIECE):
            if target.tell() + len(piece) > most:
                raise Refused(
                    f"it unpacks to more than {most} bytes, or {limits.ratio} times its size"
                )
            target.write(piece)


def _check_headers(file: IO[bytes], limits: Limits) -> None:
    """Raise Refused for too many headers, and for one too large for the reader to take into memory."""
    count = 0
    for kind, size in _headers(file):
        if kind in PAX + b"LK" and size > HEADER:
            raise Refused(f"a header of it claims {size} bytes, expected at most {HEADER}")
        count += kind not in PAX + b"LK"
    if not count:
        raise Refused("it holds no files, or is no .zip or .tar archive")
    members.check_count(count, limits)


def _headers(file: IO[bytes]) -> Iterator[tuple[bytes, int]]:
    """Yield type and size of the blocks that begin the members of a tar."""
    at = 0
    file.seek(0, os.SEEK_END)
    end = file.tell()
    while at + tarfile.BLOCKSIZE <= end:
        file.seek(at)
        block = file.read(tarfile.BLOCKSIZE)
        if not block.strip(b"\0"):
            return
        if block[257:262] != b"ustar":
            raise Refused("it is damaged, or no .zip or .tar archive (a header without its mark)")
        size = tarfile.nti(block[124:136])  # type: ignore[attr-defined]
        if size < 0:
            raise Refused("a header of it claims a size below zero")
        if block[156:157] in PAX and b" size=" in file.read(min(size, HEADER)):
            raise Refused(
                "a header of it changes the size of a member"
            )  # what follows could hide in it
        yield block[156:157], size
        at += tarfile.BLOCKSIZE * (1 + -(-size // tarfile.BLOCKSIZE))
