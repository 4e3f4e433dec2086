"""ZIP archives, byte by byte: which ones are refused, at which byte, and with which message."""

import errno
import io
import re
import struct
import zipfile
from functools import partial
from pathlib import PurePosixPath

import pytest
from support import archive_unpacking
from support.archive_unpacking import DAMAGED_MESSAGE, rejection_message
from support.malicious_archives import write_zip, zip_member

from hdrlab.course.submissions.archives import tarball
from hdrlab.course.submissions.archives.members import ArchiveRejected


@pytest.fixture
def taken(tmp_path):
    """taken(data) -> the files that are unpacked from an archive of these bytes."""
    return partial(archive_unpacking.unpack_bytes, tmp_path)


def archive(*files, **knobs):
    made = io.BytesIO()
    write_zip(made, files, **knobs)
    return made.getvalue()


def test_an_archive_of_the_largest_allowed_size_is_opened(taken):
    whole = archive(("a", b"x"))
    assert taken(whole, max_total_bytes=len(whole)) == {"a": b"x"}
    message = rejection_message(taken, whole, max_total_bytes=len(whole) - 1)
    assert str(len(whole)) in message and str(len(whole) - 1) in message


@pytest.mark.parametrize(
    ("mode", "kind"),
    [
        (0o100644, ""),
        (0, ""),
        (0o120777, "link"),
        (0o020666, "device"),
        (0o010666, "device"),
        (0o140666, "device"),
    ],
)
def test_an_entry_that_is_not_a_plain_file_is_refused_with_its_kind(mode, kind, taken):
    whole = archive((zip_member("a", mode), b"x"), ("b", b"y"))
    if kind:
        message = rejection_message(taken, whole)
        assert "'a'" in message and kind in message
    else:
        assert taken(whole) == {"a": b"x", "b": b"y"}


def test_flags_other_than_encryption_are_ignored(taken):
    whole = bytearray(archive(("a", b"x")))
    at = whole.rfind(b"PK\1\2") + 8
    whole[6] |= 2
    whole[at] |= 2
    assert taken(bytes(whole)) == {"a": b"x"}
    whole[at] |= 1
    message = rejection_message(taken, bytes(whole))
    assert "'a'" in message and "encrypted" in message


def test_a_name_with_a_null_character_is_refused(taken):
    whole = archive(("abc", b"x")).replace(b"abc", b"a\0c")
    assert "'ac'" in rejection_message(taken, whole)


def test_overlapping_members_are_refused(taken):
    whole = bytearray(archive(("a", b"xy"), ("b", b"z"), ("f/", b"")))
    assert taken(bytes(whole)) == {"a": b"xy", "b": b"z"}
    at = whole.find(b"PK\1\2") + 20
    for more, shares in ((1, False), (2, True)):  # a header has 30 bytes, and a name of one byte
        packed = whole[:]
        packed[at : at + 4] = struct.pack("<L", struct.unpack_from("<L", whole, at)[0] + more)
        message = ""
        try:
            taken(bytes(packed))
        except ArchiveRejected as error:  # a newer reader may have another reason
            message = str(error)
        assert ("'a'" in message and "shares" in message) is shares


def test_a_central_directory_cut_at_any_byte_is_refused(taken):
    whole = archive(("a", b"x"))
    for cut in (1, 21, 22, 23):
        assert "cut short" in rejection_message(taken, whole[:-cut])
    assert "cut short" in rejection_message(taken, b"PK\5\6")


def test_a_zip_without_files_is_refused(taken):
    assert "no files" in rejection_message(taken, b"PK\5\6" + bytes(18))
    assert "no files" in rejection_message(taken, archive(("a/", b"")))


def test_the_central_directory_is_found_before_a_comment_of_any_length(taken):
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as opened:
        opened.writestr("a", b"x")
        opened.comment = b"c" * 65535
    assert taken(made.getvalue()) == {"a": b"x"}


def test_a_zip64_archive_is_refused(taken):
    whole = archive(("a", b"x"))
    at = whole.rfind(b"PK\5\6")
    assert "4 GB" in rejection_message(taken, whole[:at] + b"PK\6\7" + bytes(16) + whole[at:])
    assert "4 GB" not in rejection_message(taken, whole[:at] + b"PK\6\7" + bytes(17) + whole[at:])


def test_a_central_directory_may_claim_the_largest_allowed_numbers(taken):
    whole = bytearray(archive(("a", b"x")))
    at = whole.rfind(b"PK\5\6")
    for count, size, limits in ((4, 5, ("4", "3")), (1, 3073, ("3073", "3072")), (3, 3072, ())):
        struct.pack_into("<HL", whole, at + 10, count, size)
        message = rejection_message(taken, bytes(whole), max_members=3)
        if limits:
            assert all(re.search(rf"\b{number}\b", message) for number in limits)
        else:  # it is within the limits, and damaged
            assert message.startswith(DAMAGED_MESSAGE)


def test_other_errors_of_the_zip_reader_are_shortened(taken, monkeypatch):
    for error, why in ((ValueError("n" * 200), "n" * 79 + "\u2026"), (EOFError(), "EOFError")):
        monkeypatch.setattr(
            tarball, "unpack", lambda *arguments, error=error: (_ for _ in ()).throw(error)
        )
        message = rejection_message(taken, b"x")
        assert message.startswith(DAMAGED_MESSAGE) and message.endswith(f"({why})")
    place = OSError(errno.EINVAL, "a place before the beginning")
    monkeypatch.setattr(tarball, "unpack", lambda *arguments: (_ for _ in ()).throw(place))
    assert rejection_message(taken, b"x").startswith(DAMAGED_MESSAGE)
    full = OSError(errno.ENOSPC, "no room")
    monkeypatch.setattr(tarball, "unpack", lambda *arguments: (_ for _ in ()).throw(full))
    with pytest.raises(OSError, match="no room"):
        taken(b"x")


def test_unpacked_paths_equal_those_of_the_archive(taken):
    assert set(taken(archive(("f/g/a", b"x")))) == {str(PurePosixPath("f", "g", "a"))}
