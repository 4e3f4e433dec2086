"""A zip, byte by byte: what is refused, at which byte it begins, and in which words."""

import errno
import io
import struct
import zipfile
from functools import partial
from pathlib import PurePosixPath

import pytest
import unpacking
from traps import entry, zipped
from unpacking import TOLD, refused

from hdrlab.course.submissions.archives import tarball
from hdrlab.course.submissions.archives.members import ArchiveRejected


@pytest.fixture
def taken(tmp_path):
    """taken(data) -> what is unpacked of an archive of these bytes."""
    return partial(unpacking.taken, tmp_path)


def archive(*files, **knobs):
    made = io.BytesIO()
    zipped(made, files, **knobs)
    return made.getvalue()


def test_an_archive_of_the_largest_allowed_size_is_opened(taken):
    whole = archive(("a", b"x"))
    assert taken(whole, max_total_bytes=len(whole)) == {"a": b"x"}
    said = f"it has {len(whole)} bytes, expected at most {len(whole) - 1}"
    assert refused(taken, whole, max_total_bytes=len(whole) - 1) == said


@pytest.mark.parametrize(
    ("mode", "said"),
    [
        (0o100644, ""),
        (0, ""),
        (0o120777, "'a' is a link, expected plain files"),
        (0o020666, "'a' is a device, expected plain files"),
        (0o010666, "'a' is a device, expected plain files"),
        (0o140666, "'a' is a device, expected plain files"),
    ],
)
def test_an_entry_that_is_not_a_plain_file_is_refused_with_its_kind(mode, said, taken):
    whole = archive((entry("a", mode), b"x"), ("b", b"y"))
    if said:
        assert refused(taken, whole) == said
    else:
        assert taken(whole) == {"a": b"x", "b": b"y"}


def test_flags_other_than_encryption_are_ignored(taken):
    whole = bytearray(archive(("a", b"x")))
    at = whole.rfind(b"PK\1\2") + 8
    whole[6] |= 2
    whole[at] |= 2
    assert taken(bytes(whole)) == {"a": b"x"}
    whole[at] |= 1
    assert refused(taken, bytes(whole)) == "'a' is encrypted"


def test_a_name_with_a_null_character_is_refused(taken):
    whole = archive(("abc", b"x")).replace(b"abc", b"a\0c")
    assert refused(taken, whole) == "'ac' has a control character in its name"


def test_overlapping_members_are_refused(taken):
    whole = bytearray(archive(("a", b"xy"), ("b", b"z"), ("f/", b"")))
    assert taken(bytes(whole)) == {"a": b"xy", "b": b"z"}
    at = whole.find(b"PK\1\2") + 20
    for more, shares in ((1, False), (2, True)):  # a header has 30 bytes, and a name of one byte
        packed = whole[:]
        packed[at : at + 4] = struct.pack("<L", struct.unpack_from("<L", whole, at)[0] + more)
        said = ""
        try:
            taken(bytes(packed))
        except ArchiveRejected as error:  # a newer reader may have another reason
            said = str(error)
        assert (said == "'a' shares its bytes with another member") is shares


def test_a_central_directory_cut_at_any_byte_is_refused(taken):
    whole = archive(("a", b"x"))
    said = "it is cut short: its list of members is missing"
    for cut in (1, 21, 22, 23):
        assert refused(taken, whole[:-cut]) == said
    assert refused(taken, b"PK\5\6") == said


def test_a_zip_without_files_is_refused(taken):
    assert refused(taken, b"PK\5\6" + bytes(18)) == "it holds no files"
    assert refused(taken, archive(("a/", b""))) == "it holds no files"


def test_the_central_directory_is_found_before_a_comment_of_any_length(taken):
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as opened:
        opened.writestr("a", b"x")
        opened.comment = b"c" * 65535
    assert taken(made.getvalue()) == {"a": b"x"}


def test_a_zip64_archive_is_refused(taken):
    whole = archive(("a", b"x"))
    at = whole.rfind(b"PK\5\6")
    said = "it is a zip for more than 4 GB or 65535 members"
    assert refused(taken, whole[:at] + b"PK\6\7" + bytes(16) + whole[at:]) == said
    assert said not in refused(taken, whole[:at] + b"PK\6\7" + bytes(17) + whole[at:])


def test_a_central_directory_may_claim_the_largest_allowed_numbers(taken):
    whole = bytearray(archive(("a", b"x")))
    at = whole.rfind(b"PK\5\6")
    for count, size, said in (
        (4, 5, "it has 4 members, expected at most 3"),
        (1, 3073, "its list of members takes 3073 bytes, expected at most 3072"),
        (3, 3072, TOLD),
    ):
        struct.pack_into("<HL", whole, at + 10, count, size)
        assert refused(taken, bytes(whole), max_members=3).startswith(said)


def test_other_errors_of_the_zip_reader_are_shortened(taken, monkeypatch):
    for error, why in ((ValueError("n" * 200), "n" * 79 + "\u2026"), (EOFError(), "EOFError")):
        monkeypatch.setattr(
            tarball, "unpack", lambda *given, error=error: (_ for _ in ()).throw(error)
        )
        assert refused(taken, b"x") == f"{TOLD} ({why})"
    place = OSError(errno.EINVAL, "a place before the beginning")
    monkeypatch.setattr(tarball, "unpack", lambda *given: (_ for _ in ()).throw(place))
    assert refused(taken, b"x").startswith(TOLD)
    full = OSError(errno.ENOSPC, "no room")
    monkeypatch.setattr(tarball, "unpack", lambda *given: (_ for _ in ()).throw(full))
    with pytest.raises(OSError, match="no room"):
        taken(b"x")


def test_unpacked_paths_equal_those_of_the_archive(taken):
    assert set(taken(archive(("f/g/a", b"x")))) == {str(PurePosixPath("f", "g", "a"))}
