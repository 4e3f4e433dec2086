"""Tar archives, byte by byte: which ones are refused, at which byte, and with which message."""

import bz2
import gzip
import lzma
import os
import tarfile
from functools import partial

import pytest
from support import archive_unpacking
from support.archive_unpacking import rejection_message
from support.malicious_archives import tar_member

from hdrlab.course.submissions.archives import tarball
from hdrlab.course.submissions.archives.members import ArchiveLimits, ArchiveRejected


@pytest.fixture
def taken(tmp_path):
    """taken(data) -> the files that are unpacked from an archive of these bytes."""
    return partial(archive_unpacking.unpack_bytes, tmp_path)


def header(name="a", kind=b"0", size=0):
    """Return the header of a member of a tar file, 512 bytes."""
    made = tar_member(name, kind)
    made.size = size
    return made.tobuf(tarfile.USTAR_FORMAT)


def block(data):
    return data + bytes(-len(data) % 512)


END = bytes(1024)


@pytest.mark.parametrize("size", [0, 1, 511, 512, 513, 1024])
def test_a_tar_with_members_of_any_size_is_read(size, taken):
    data = os.urandom(size)
    whole = header("a", size=size) + block(data) + header("f/b", size=1) + block(b"x") + END
    assert taken(whole) == {"a": data, "f/b": b"x"}
    assert taken(header("folder", b"5") + whole) == {"a": data, "f/b": b"x"}
    assert taken(header("folder", b"5")) == {}
    if size:
        message = rejection_message(taken, whole, max_file_bytes=size - 1)
        assert f"'a' claims {size} " in message and str(size - 1) in message
    else:
        assert taken(whole, max_file_bytes=1)


def test_an_empty_tar_is_refused(taken):
    for data in (b"", bytes(511), bytes(512), END):
        assert "no files" in rejection_message(taken, data)


def test_a_tar_that_ends_at_its_last_block_is_whole(taken):
    assert taken(header("a")) == {"a": b""}
    assert taken(header("a", size=3) + block(b"abc")) == {"a": b"abc"}


def test_a_header_without_its_magic_bytes_is_refused(taken):
    assert "header" in rejection_message(taken, b"x" * 512)
    assert taken(header("a") + b"x" * 511) == {"a": b""}
    damaged = bytearray(header("b"))
    for at in (257, 261):
        damaged[at] ^= 1
        assert "header" in rejection_message(taken, header("a") + bytes(damaged) + END)
        damaged[at] ^= 1
    assert taken(header("a") + bytes(damaged) + END) == {"a": b"", "b": b""}


@pytest.mark.parametrize(
    ("kind", "word"),
    [(b"2", "link"), (b"1", "link"), (b"3", "device"), (b"6", "device")],
)
def test_a_member_that_is_not_a_plain_file_is_refused_with_its_kind(kind, word, taken):
    message = rejection_message(taken, header("ok") + header("a", kind) + END)
    assert "'a'" in message and word in message


@pytest.mark.parametrize("kind", [b"x", b"g", b"X", b"L", b"K"])
def test_an_extended_header_has_a_limited_size(kind, taken):
    assert "65537" in rejection_message(taken, header("a", kind, 65537) + bytes(65536 + 512))
    assert "65536" not in rejection_message(taken, header("a", kind, 65536) + bytes(65536))


def test_a_plain_file_may_be_larger_than_a_header(taken):
    assert taken(header("a", size=65537) + block(b"x" * 65537)) == {"a": b"x" * 65537}


@pytest.mark.parametrize("kind", [b"x", b"g", b"X"])
def test_an_extended_header_that_changes_a_size_is_refused(kind, taken):
    rest = b"11 size=513\n"
    for before in (b"", b"13 path=abcd\n" * 30):
        data = before + rest
        message = rejection_message(taken, header("p", kind, len(data)) + block(data) + header("a"))
        assert "header" in message and "size" in message
    words = b"20 comment=ab size=\n"
    assert taken(header("p", b"0", len(words)) + block(words)) == {"p": words}


def test_a_size_may_be_binary_or_octal(taken):
    written = bytearray(header("a"))
    written[124:136] = b"\x80" + bytes(10) + b"\3"
    written[148:156] = b"%06o\0 " % (sum(written[:148]) + 8 * 32 + sum(written[156:]))
    assert taken(bytes(written) + block(b"abc") + header("b")) == {"a": b"abc", "b": b""}


def test_a_size_below_zero_is_refused(taken):
    damaged = bytearray(header("a"))
    damaged[124:136] = b"\xff" * 12
    assert "size" in rejection_message(taken, bytes(damaged) + END)


def test_extended_headers_do_not_count_as_members(taken):
    path = b"13 path=abcd\n"
    assert len(path) == 13
    named = header("p", b"x", 13) + block(path) + header("a", size=1) + block(b"1")
    assert taken(named + END, max_members=1) == {"abcd": b"1"}
    long = header("././@LongLink", b"L", 5) + block(b"long\0") + header("a", size=1) + block(b"1")
    assert taken(long + END, max_members=1) == {"long": b"1"}
    assert "2 members" in rejection_message(taken, named + long, max_members=1)
    assert "no files" in rejection_message(taken, header("p", b"x", 13) + block(path))


def test_folders_count_as_members(taken):
    folders = b"".join(header(name, b"5") for name in "bcd")
    assert "4 members" in rejection_message(taken, folders + header("a"), max_members=3)


# a tar may unpack to what the limits allow, and of each member a header and the rest of a block,
# and a record
@pytest.mark.parametrize("more", [0, 512])
def test_an_uncompressed_tar_is_limited_in_size(more, tmp_path):
    limits = ArchiveLimits(max_members=3, max_total_bytes=70_000, max_compression_ratio=1)
    most = 70_000 + 3 * 1024 + 10240
    archive = tmp_path / "a"
    fresh = tmp_path / "fresh"
    fresh.mkdir()
    archive.write_bytes(header("a") + bytes(most - 512) + bytes(more))
    if more:
        with pytest.raises(ArchiveRejected, match=f"{most} bytes"):
            tarball.unpack(archive, fresh, limits)
    else:
        assert len(tarball.unpack(archive, fresh, limits)) == 1


@pytest.mark.parametrize("packing", [gzip, bz2, lzma])
def test_a_compressed_tar_is_limited_in_its_compression_ratio(packing, taken):
    most = 1 << 20
    data = os.urandom(6000)
    whole = header("a", size=6000) + data + bytes(most - 6512)
    assert taken(packing.compress(whole), max_compression_ratio=1) == {"a": data}
    larger = packing.compress(whole + b"\0")
    assert str(most) in rejection_message(taken, larger, max_compression_ratio=1)
    enough = most // len(larger) + 1
    assert taken(larger, max_compression_ratio=enough) == {"a": data}
    message = rejection_message(taken, larger, max_compression_ratio=enough - 1)
    assert str(most) in message and str(enough - 1) in message
    assert rejection_message(
        taken, larger, max_compression_ratio=enough, max_total_bytes=6000, max_members=1
    ).startswith("it has")
    message = rejection_message(
        taken, larger, max_compression_ratio=enough, max_total_bytes=8000, max_members=1
    )
    assert str(8000 + 1024 + 10240) in message
