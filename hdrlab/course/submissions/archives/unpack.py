"""Unpack archives that students send, without trust: .zip, .tar and compressed .tar.

The whole list of members is checked before the first byte is written: names (absolute, with .., a
backslash or control characters, duplicate, or differing only in case), kinds (no links, no
devices), sizes, counts, depths, compression ratios, entries that share bytes, and encryption. While
the files are written, their real sizes are checked, too. An archive is either unpacked whole or
rejected whole, with one line that says why. An archive inside an archive is treated as a plain
file.
"""

import errno
import os
import struct
import tarfile
import zipfile
import zlib
from collections.abc import Sequence
from pathlib import Path

from hdrlab.course.sanitize import sanitize_line
from hdrlab.course.submissions.archives import members, tarball
from hdrlab.course.submissions.archives.members import (
    LIMITS,
    ArchiveLimits,
    ArchiveRejected,
    Member,
    quote_name,
)
from hdrlab.io.temporary import temporary_folder

# what the readers of the standard library raise for a damaged archive
READER_ERRORS = (
    OSError,
    EOFError,
    ValueError,
    RuntimeError,
    OverflowError,
    MemoryError,
    IndexError,
    struct.error,
    tarfile.TarError,
    zipfile.BadZipFile,
    zlib.error,
)
MAX_REASON_CHARACTERS = 80

# the first bytes of a zip archive, with and without members
MEMBER_SIGNATURE = b"PK\3\4"
END_SIGNATURE = b"PK\5\6"
# for a zip archive of more than 4 GB or 65535 members, before the end record
ZIP64_SIGNATURE = b"PK\6\7"
ZIP64_LOCATOR_BYTES = 20
# the header that stands before a member, at least
MEMBER_HEADER_BYTES = 30
# a member's entry in the list: 46 bytes, a name, and what some programs add
MAX_LIST_ENTRY_BYTES = 1024
# the record at the end of the list, without its comment
END_RECORD_BYTES = 22
MAX_COMMENT_BYTES = 2**16
# where in the end record the number of members and the size of the list are
END_RECORD_COUNT_OFFSET = 10
# flag of an entry
ENCRYPTED_FLAG = 0x1
# Unix file types, in the uppermost bits of an entry's attributes
FILE_TYPE_SHIFT = 28
UNKNOWN_TYPE = 0
REGULAR_FILE_TYPE = 0o10
LINK_TYPE = 0o12


def unpack(archive: str | Path, target: str | Path, limits: ArchiveLimits = LIMITS) -> list[Member]:
    """Unpack an archive into a new folder, and return its files.

    Parameters
    ----------
    archive : str or Path
        A .zip, .tar, .tar.gz, .tgz, .tar.bz2 or .tar.xz file. Its content decides which, not its
        name.
    target : str or Path
        The folder to create. It appears when all files are written.
    limits : ArchiveLimits
        How much the archive may hold.

    Raises
    ------
    ArchiveRejected
        If the archive is damaged or holds something that no submission needs. Nothing is left
        behind.
    FileExistsError
        If `target` exists.
    """
    archive = Path(archive)
    target = Path(target)
    if target.exists():
        raise FileExistsError(f"expected a folder that does not exist yet, got {target}")
    packed_bytes = archive.stat().st_size
    if packed_bytes > limits.max_total_bytes:
        raise ArchiveRejected(
            f"it has {packed_bytes} bytes, expected at most {limits.max_total_bytes}"
        )
    with temporary_folder(target.parent) as scratch:
        folder = scratch / "files"
        folder.mkdir()
        try:
            if _is_zip(archive):
                files = _unpack_zip(archive, folder, limits)
            else:
                files = tarball.unpack(archive, folder, limits)
        except ArchiveRejected:
            raise
        except _reader_errors() as error:
            if _is_fault_of_system(error):
                raise
            reason = sanitize_line(str(error) or type(error).__name__, MAX_REASON_CHARACTERS)
            raise ArchiveRejected(
                f"it is damaged, or not a .zip or .tar archive ({reason})"
            ) from None
        os.rename(folder, target)
    return files


def _reader_errors() -> tuple[type[BaseException], ...]:
    """Return READER_ERRORS, and the error of lzma if this Python has it."""
    try:
        import lzma
    except ImportError:
        return READER_ERRORS
    return (*READER_ERRORS, lzma.LZMAError)


def _is_fault_of_system(error: BaseException) -> bool:
    """Return whether an error comes from the system, such as a full disk, and not from the archive.

    An archive may lead its reader to a place before the start of the file, which is EINVAL.
    """
    error_number = getattr(error, "errno", None)
    return error_number not in (None, errno.EINVAL)


def _is_zip(archive: Path) -> bool:
    """Return whether a file starts as a zip archive."""
    with open(archive, "rb") as file:
        return file.read(len(MEMBER_SIGNATURE)) in (MEMBER_SIGNATURE, END_SIGNATURE)


def _unpack_zip(archive: Path, folder: Path, limits: ArchiveLimits) -> list[Member]:
    """Unpack a zip archive into an empty folder, and return its files."""
    _check_list_size(archive, limits)
    with zipfile.ZipFile(archive) as zip_file:
        # again, because the end record may lie about the number of members
        members.check_count(len(zip_file.infolist()), limits)
        infos = [info for info in zip_file.infolist() if not info.is_dir()]
        if not infos:
            raise ArchiveRejected("it holds no files")
        for info in infos:
            _check_entry(info)
        # the original name: zipfile cuts names at a null character
        paths = members.check_names([info.orig_filename for info in infos], limits)
        files = [Member(path, info.file_size) for path, info in zip(paths, infos, strict=True)]
        members.check_sizes(files, archive.stat().st_size, limits)
        _check_overlaps(infos, zip_file.start_dir)
        for info, file in zip(infos, files, strict=True):
            with zip_file.open(info) as source:
                members.write_member(source, folder / file.path, file.size)
    return files


def _check_entry(info: zipfile.ZipInfo) -> None:
    """Raise ArchiveRejected if an entry is a link, a device or encrypted."""
    # it is unknown if the archive was not made on Unix
    file_type = info.external_attr >> FILE_TYPE_SHIFT
    if file_type not in (UNKNOWN_TYPE, REGULAR_FILE_TYPE):
        kind = "link" if file_type == LINK_TYPE else "device"
        raise ArchiveRejected(f"{quote_name(info.filename)} is a {kind}, expected plain files")
    if info.flag_bits & ENCRYPTED_FLAG:
        raise ArchiveRejected(f"{quote_name(info.filename)} is encrypted")
    if "\0" in info.orig_filename:
        name = quote_name(info.orig_filename)
        raise ArchiveRejected(f"{name} has a control character in its name")


def _check_overlaps(infos: Sequence[zipfile.ZipInfo], list_start: int) -> None:
    """Raise ArchiveRejected if entries share bytes, as in a small archive that unpacks to very much.

    Parameters
    ----------
    infos : sequence of ZipInfo
        The entries.
    list_start : int
        Where the list of members starts, behind all entries.
    """
    in_order = sorted(
        infos, key=lambda info: (info.header_offset, info.compress_size, info.filename)
    )
    next_starts = [info.header_offset for info in in_order[1:]]
    next_starts.append(list_start)
    for info, next_start in zip(in_order, next_starts, strict=True):
        end = info.header_offset + MEMBER_HEADER_BYTES + info.compress_size
        if end > next_start:
            name = quote_name(info.filename)
            raise ArchiveRejected(f"{name} shares its bytes with another member")


def _check_list_size(archive: Path, limits: ArchiveLimits) -> None:
    """Raise ArchiveRejected if the list of members is missing, or too large for memory."""
    # the end record, its comment, and what may stand before them
    tail_bytes = MAX_COMMENT_BYTES + 64
    with open(archive, "rb") as file:
        file.seek(max(0, archive.stat().st_size - tail_bytes))
        tail = file.read()
    end_record = tail.rfind(END_SIGNATURE)
    if end_record < 0 or len(tail) < end_record + END_RECORD_BYTES:
        raise ArchiveRejected("it is cut short: its list of members is missing")
    if ZIP64_SIGNATURE in tail[max(0, end_record - ZIP64_LOCATOR_BYTES) : end_record]:
        raise ArchiveRejected("it is a zip for more than 4 GB or 65535 members")
    count, list_bytes = struct.unpack_from("<HL", tail, end_record + END_RECORD_COUNT_OFFSET)
    members.check_count(count, limits)
    max_list_bytes = limits.max_members * MAX_LIST_ENTRY_BYTES
    if list_bytes > max_list_bytes:
        raise ArchiveRejected(
            f"its list of members takes {list_bytes} bytes, expected at most {max_list_bytes}"
        )
