"""Archives that students send, unpacked without trust: .zip, .tar and compressed .tar.

All of a list is judged before the first byte is written. What is judged: names (absolute, with ..
or a backslash, twice, alike but for case, with control characters), kinds (links and devices are no
submissions), sizes (claimed and real ones), counts, depths, ratios of compression, entries that
share bytes, encryption. An archive is taken whole or refused whole, with one line that says why. An
archive inside it is a file.
"""

import errno
import lzma
import os
import struct
import tarfile
import tempfile
import zipfile
import zlib
from collections.abc import Sequence
from pathlib import Path

from hdrlab.course.sanitize import sanitize_line
from hdrlab.course.submissions.archives import members, tarball
from hdrlab.course.submissions.archives.members import LIMITS, Limits, Member, Refused, quote_name

DAMAGE = (
    OSError,
    EOFError,
    ValueError,
    RuntimeError,
    OverflowError,
    MemoryError,
    IndexError,
    struct.error,
)
FAULTS = (
    *DAMAGE,
    tarfile.TarError,
    zipfile.BadZipFile,
    lzma.LZMAError,
    zlib.error,
)  # of the readers
LOCAL = 30  # bytes of the header that stands before a member of a zip
ENTRY = 1024  # bytes of its entry in the list, at most: 46, a name, and what some programs add


def unpack(archive: str | Path, target: str | Path, limits: Limits = LIMITS) -> list[Member]:
    """Unpack an archive into a folder that does not exist yet, and return its files.

    Parameters
    ----------
    archive : .zip, .tar, .tar.gz, .tgz, .tar.bz2 or .tar.xz, told by its content
    target : the new folder; it is there when all of it is, and not before
    limits : what is too much

    Raises
    ------
    Refused
        For an archive that is damaged, or holds what no submission needs; nothing is left behind.
    FileExistsError
        Where `target` is there.
    """
    archive, target = Path(archive), Path(target)
    if target.exists():
        raise FileExistsError(f"expected a folder that is not there yet, got {target}")
    if (size := archive.stat().st_size) > limits.total:
        raise Refused(f"it has {size} bytes, expected at most {limits.total}")
    with tempfile.TemporaryDirectory(prefix=".unpack-", dir=target.parent) as scratch:
        fresh = Path(scratch) / "files"
        fresh.mkdir()
        try:
            found = (_zip if _is_zip(archive) else tarball.unpack)(archive, fresh, limits)
        except FAULTS as error:
            # a full disk is not the archive's fault; a place before its beginning is
            if isinstance(error, Refused) or getattr(error, "errno", None) not in (
                None,
                errno.EINVAL,
            ):
                raise
            why = sanitize_line(str(error) or type(error).__name__, 80)
            raise Refused(f"it is damaged, or no .zip or .tar archive ({why})") from None
        os.rename(fresh, target)
    return found


def _is_zip(archive: Path) -> bool:
    with open(archive, "rb") as file:
        return file.read(4) in (b"PK\3\4", b"PK\5\6")


def _zip(archive: Path, fresh: Path, limits: Limits) -> list[Member]:
    _check_list(archive, limits)
    with zipfile.ZipFile(archive) as opened:
        infos = [info for info in opened.infolist() if not info.is_dir()]
        members.check_count(len(opened.infolist()), limits)
        if not infos:
            raise Refused("it holds no files")
        for info in infos:
            _check_entry(info)
        paths = members.check_names([info.orig_filename for info in infos], limits)
        found = [Member(path, info.file_size) for path, info in zip(paths, infos, strict=True)]
        members.check_sizes(found, archive.stat().st_size, limits)
        _check_apart(infos, opened.start_dir)
        for info, member in zip(infos, found, strict=True):
            with opened.open(info) as source:
                members.write(source, fresh / member.path, member.size)
    return found


def _check_entry(info: zipfile.ZipInfo) -> None:
    """Raise Refused for an entry that is a link or a device, or is encrypted."""
    kind = info.external_attr >> 28  # the file type of Unix, 0 where the archive was made elsewhere
    if kind not in (0, 0o10):
        what = "link" if kind == 0o12 else "device"
        raise Refused(f"{quote_name(info.filename)} is a {what}, expected plain files")
    if info.flag_bits & 0x1:
        raise Refused(f"{quote_name(info.filename)} is encrypted")
    if "\0" in info.orig_filename:
        raise Refused(f"{quote_name(info.orig_filename)} has a control character in its name")


def _check_apart(infos: Sequence[zipfile.ZipInfo], end: int) -> None:
    """Raise Refused where entries share bytes: so a bomb of one kernel claims many files."""
    starts = sorted(
        (info.header_offset, info.compress_size + LOCAL, info.filename) for info in infos
    )
    for (start, size, name), after in zip(
        starts, [*(at for at, *_ in starts[1:]), end], strict=True
    ):
        if start + size > after:
            raise Refused(f"{quote_name(name)} shares its bytes with another member")


def _check_list(archive: Path, limits: Limits) -> None:
    """Raise Refused for a list of members that the reader could not hold in memory."""
    with open(archive, "rb") as file:
        file.seek(max(0, archive.stat().st_size - (1 << 16) - 64))
        tail = file.read()
    at = tail.rfind(b"PK\5\6")
    if at < 0 or len(tail) < at + 22:
        raise Refused("it is cut short: its list of members is missing")
    count, size = struct.unpack_from("<HL", tail, at + 10)
    if b"PK\6\7" in tail[max(0, at - 20) : at]:
        raise Refused("it is a zip for more than 4 GB or 65535 members")
    members.check_count(count, limits)
    if size > limits.members * ENTRY:
        raise Refused(
            f"its list of members takes {size} bytes, expected at most {limits.members * ENTRY}"
        )
