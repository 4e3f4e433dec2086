"""Unpack tar archives, compressed or not, and check their headers before tarfile reads them.

A compressed notebook or Python file, such as hw2.ipynb.gz, is taken for an archive of this file.
"""

import bz2
import gzip
import os
import tarfile
import tempfile
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import IO, Any

from hdrlab.course.submissions.archives import members
from hdrlab.course.submissions.archives.members import (
    CHUNK_BYTES,
    MIN_CHECKED_RATIO_BYTES,
    ArchiveLimits,
    ArchiveRejected,
    Member,
    quote_name,
)


def _open_xz(path: Path, mode: str) -> Any:
    """Open a file that is compressed by xz."""
    try:
        # some builds of Python lack it, and few archives need it
        import lzma
    except ImportError:
        raise ArchiveRejected("this Python cannot unpack .xz; use .zip or .tar.gz") from None
    return lzma.open(path, mode)


# by the first bytes of a compressed archive
OPENERS: dict[bytes, Any] = {b"\x1f\x8b": gzip.open, b"BZh": bz2.open, b"\xfd7zXZ\0": _open_xz}
MAX_MAGIC_BYTES = 6
# files that may be compressed alone
SINGLE_FILE_SUFFIXES = (".ipynb", ".py")

# Extended headers, which change the members after them: their types are x for the next member, g
# for all, and X for the next one by Solaris.
PAX_TYPES = b"xgX"
# headers with a long name or a long link target for the next member, by GNU
LONG_NAME_TYPES = b"LK"
# of the content of these headers, which tarfile reads into memory
MAX_EXTENDED_HEADER_BYTES = 64 * 2**10

# fields of a header block
SIZE_FIELD = slice(124, 136)
TYPE_FIELD = slice(156, 157)
MAGIC_FIELD = slice(257, 262)
MAGIC = b"ustar"


def unpack(archive: Path, folder: Path, limits: ArchiveLimits) -> list[Member]:
    """Unpack a tar archive into an empty folder, and return its files.

    Raises
    ------
    ArchiveRejected
        If it contains something that no submission needs.
    """
    packed_bytes = archive.stat().st_size
    with tempfile.TemporaryFile(dir=folder.parent) as plain_tar:
        _decompress(archive, plain_tar, packed_bytes, limits)
        if _is_single_file(plain_tar, archive):
            return _write_single_file(plain_tar, archive, folder, limits)
        _check_headers(plain_tar, limits)
        plain_tar.seek(0)
        with closing(tarfile.open(fileobj=plain_tar, mode="r:")) as tar:
            infos = [info for info in tar.getmembers() if not info.isdir()]
            for info in infos:
                _check_kind(info)
            paths = members.check_names([info.name for info in infos], limits)
            files = [Member(path, info.size) for path, info in zip(paths, infos, strict=True)]
            members.check_sizes(files, packed_bytes, limits)
            for info, file in zip(infos, files, strict=True):
                source = tar.extractfile(info)
                # it is None for folders and devices only
                assert source is not None
                members.write_member(source, folder / file.path, file.size)
    return files


def _is_single_file(file: IO[bytes], archive: Path) -> bool:
    """Return whether the unpacked content of hw2.ipynb.gz is this notebook, and no tar archive."""
    file.seek(0)
    has_header = file.read(tarfile.BLOCKSIZE)[MAGIC_FIELD] == MAGIC
    is_compressed = _find_opener(archive) is not open
    return is_compressed and not has_header and archive.stem.lower().endswith(SINGLE_FILE_SUFFIXES)


def _write_single_file(
    file: IO[bytes], archive: Path, folder: Path, limits: ArchiveLimits
) -> list[Member]:
    """Write a file that was compressed alone, under the name of the archive without its suffix."""
    (path,) = members.check_names([archive.stem], limits)
    size = file.seek(0, os.SEEK_END)
    file.seek(0)
    members.write_member(file, folder / path, size)
    return [Member(path, size)]


def _check_kind(info: tarfile.TarInfo) -> None:
    """Raise ArchiveRejected if a member is not a plain file."""
    if info.isreg() and not info.issparse():
        return
    kind = "link" if info.issym() or info.islnk() else "device or a sparse file"
    raise ArchiveRejected(f"{quote_name(info.name)} is a {kind}, expected plain files")


def _decompress(archive: Path, target: IO[bytes], packed_bytes: int, limits: ArchiveLimits) -> None:
    """Write the archive without its compression, or raise ArchiveRejected if it gets too large."""
    opener = _find_opener(archive)
    # for each member its header, and padding to a whole block; at the end, padding to a record
    overhead = limits.max_members * 2 * tarfile.BLOCKSIZE + tarfile.RECORDSIZE
    max_bytes = limits.max_total_bytes + overhead
    if opener is not open:
        max_unpacked_bytes = limits.max_compression_ratio * packed_bytes
        max_bytes = min(max_bytes, max(max_unpacked_bytes, MIN_CHECKED_RATIO_BYTES))
    with opener(archive, "rb") as source:
        while chunk := source.read(CHUNK_BYTES):
            if target.tell() + len(chunk) > max_bytes:
                raise ArchiveRejected(
                    f"it unpacks to more than {max_bytes} bytes, "
                    f"or {limits.max_compression_ratio} times its size"
                )
            target.write(chunk)


def _find_opener(archive: Path) -> Any:
    """Return the function that opens an archive, decided by its first bytes."""
    with open(archive, "rb") as file:
        first_bytes = file.read(MAX_MAGIC_BYTES)
    for magic, opener in OPENERS.items():
        if first_bytes.startswith(magic):
            return opener
    return open


def _check_headers(file: IO[bytes], limits: ArchiveLimits) -> None:
    """Raise ArchiveRejected if there are too many members, or a header is too large for memory."""
    member_count = 0
    for kind, size in _iter_headers(file):
        if kind not in PAX_TYPES + LONG_NAME_TYPES:
            member_count += 1
        elif size > MAX_EXTENDED_HEADER_BYTES:
            raise ArchiveRejected(
                f"a header of it claims {size} bytes, expected at most {MAX_EXTENDED_HEADER_BYTES}"
            )
    if member_count == 0:
        raise ArchiveRejected("it holds no files, or is not a .zip or .tar archive")
    members.check_count(member_count, limits)


def _iter_headers(file: IO[bytes]) -> Iterator[tuple[bytes, int]]:
    """Yield the type and the size of each header block of a tar archive."""
    file.seek(0, os.SEEK_END)
    end = file.tell()
    position = 0
    while position + tarfile.BLOCKSIZE <= end:
        file.seek(position)
        block = file.read(tarfile.BLOCKSIZE)
        # a block of zeros ends the archive
        if not block.strip(b"\0"):
            return
        if block[MAGIC_FIELD] != MAGIC:
            raise ArchiveRejected(
                "it is damaged, or not a .zip or .tar archive (a header without its mark)"
            )
        size = tarfile.nti(block[SIZE_FIELD])  # type: ignore[attr-defined]
        if size < 0:
            raise ArchiveRejected("a header of it claims a size below zero")
        kind = block[TYPE_FIELD]
        if kind in PAX_TYPES:
            content = file.read(min(size, MAX_EXTENDED_HEADER_BYTES))
            # a member could hide in the content of another whose size is changed
            if b" size=" in content:
                raise ArchiveRejected("a header of it changes the size of a member")
        yield kind, size
        # the content is padded to whole blocks
        content_blocks = -(-size // tarfile.BLOCKSIZE)
        position += tarfile.BLOCKSIZE * (1 + content_blocks)
