"""Archives of students: ordinary ones are unpacked, and malicious ones are refused in one line."""

import bz2
import gzip
import lzma
import stat
from contextlib import nullcontext
from dataclasses import replace
from pathlib import PurePosixPath

import pytest
from support.malicious_archives import (
    HARMLESS_FILES,
    MALICIOUS_ARCHIVES,
    tar_member,
    write_tar,
    write_zip,
)

from hdrlab.course.submissions.archives.members import (
    LIMITS,
    ArchiveLimits,
    ArchiveRejected,
    Member,
    check_sizes,
)
from hdrlab.course.submissions.archives.unpack import unpack

SMALL = ArchiveLimits(
    max_members=20,
    max_total_bytes=200_000,
    max_file_bytes=100_000,
    max_depth=4,
    max_name_bytes=60,
    max_compression_ratio=50,
)


@pytest.mark.parametrize("limits", [SMALL, LIMITS], ids=["small", "usual"])
@pytest.mark.parametrize("trap", MALICIOUS_ARCHIVES)
def test_a_trap_is_refused_with_one_line_and_leaves_nothing(trap, limits, tmp_path):
    room = tmp_path / "room" / "inner"
    room.mkdir(parents=True)
    archive = tmp_path / "submission"
    MALICIOUS_ARCHIVES[trap](archive)
    with pytest.raises(ArchiveRejected) as refused:
        unpack(archive, room / "new", limits)
    message = str(refused.value)
    assert message and len(message) < 200 and message.isprintable()
    assert sorted(tmp_path.rglob("*")) == sorted([room.parent, room, archive])


@pytest.mark.parametrize("mode", ["zip", "w", "w:gz", "w:bz2", "w:xz"])
def test_a_plain_archive_is_unpacked_byte_by_byte(mode, tmp_path):
    archive = tmp_path / "archive"
    if mode == "zip":
        write_zip(archive, {"photographs/": b""} | HARMLESS_FILES)
    else:
        write_tar(
            archive, [(tar_member(name), data) for name, data in HARMLESS_FILES.items()], mode
        )
    members = unpack(archive, tmp_path / "new")
    assert {str(path): size for path, size in members} == {
        name: len(data) for name, data in HARMLESS_FILES.items()
    }
    assert {
        name: (tmp_path / "new" / name).read_bytes() for name in HARMLESS_FILES
    } == HARMLESS_FILES


@pytest.mark.parametrize("module", [gzip, bz2, lzma])
def test_a_notebook_that_is_compressed_alone_is_unpacked(module, tmp_path):
    archive = tmp_path / "hw2.ipynb.packed"
    archive.write_bytes(module.compress(b'{"cells": []}'))
    assert unpack(archive, tmp_path / "new") == [Member(PurePosixPath("hw2.ipynb"), 13)]
    assert (tmp_path / "new" / "hw2.ipynb").read_bytes() == b'{"cells": []}'


def test_a_compressed_file_that_is_no_code_is_refused(tmp_path):
    archive = tmp_path / "photo.jpg.gz"
    archive.write_bytes(gzip.compress(b"no tar" * 200))
    with pytest.raises(ArchiveRejected, match="not a .zip or .tar archive"):
        unpack(archive, tmp_path / "new")


def test_a_notebook_that_is_compressed_alone_must_not_unpack_to_many_times_its_size(tmp_path):
    archive = tmp_path / "hw2.ipynb.gz"
    archive.write_bytes(gzip.compress(bytes(300_000_000)))
    with pytest.raises(ArchiveRejected, match="times its size"):
        unpack(archive, tmp_path / "new")


def test_file_permissions_of_an_archive_are_ignored(tmp_path):
    write_tar(tmp_path / "a.tar", [(tar_member("run", mode=0o6777), b"#!/bin/sh")])
    unpack(tmp_path / "a.tar", tmp_path / "new")
    assert stat.S_IMODE((tmp_path / "new" / "run").stat().st_mode) & 0o6111 == 0


def test_an_archive_inside_an_archive_stays_packed(tmp_path):
    inner = write_zip(tmp_path / "inner.zip", {"../x": b"x"})
    write_zip(tmp_path / "outer.zip", {"inner.zip": inner.read_bytes()})
    assert [str(path) for path, _ in unpack(tmp_path / "outer.zip", tmp_path / "new")] == [
        "inner.zip"
    ]


def test_an_existing_folder_is_not_changed(tmp_path):
    write_zip(tmp_path / "a.zip", HARMLESS_FILES)
    (tmp_path / "new").mkdir()
    with pytest.raises(FileExistsError):
        unpack(tmp_path / "a.zip", tmp_path / "new")


def test_a_zip_with_a_wrong_member_count_is_counted_again(tmp_path):
    archive = write_zip(tmp_path / "many.zip", {f"{k}.txt": b"x" for k in range(5)})
    data = bytearray(archive.read_bytes())
    at = data.rfind(b"PK\5\6")
    data[at + 8 : at + 12] = b"\1\0\1\0"  # it says that there is one
    archive.write_bytes(data)
    with pytest.raises(ArchiveRejected, match="members|files"):
        unpack(archive, tmp_path / "out", ArchiveLimits(max_members=4))
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("kind", ["zip", "tar"])
def test_as_many_members_as_are_allowed_are_unpacked_and_one_more_is_refused(kind, tmp_path):
    for count in (4, 5):
        archive = tmp_path / f"{count}.{kind}"
        files = {f"{k}.txt": b"x" for k in range(count)}
        if kind == "zip":
            write_zip(archive, files)
        else:
            write_tar(archive, [(tar_member(name), data) for name, data in files.items()])
    assert len(unpack(tmp_path / f"4.{kind}", tmp_path / "four", ArchiveLimits(max_members=4))) == 4
    with pytest.raises(ArchiveRejected):
        unpack(tmp_path / f"5.{kind}", tmp_path / "five", ArchiveLimits(max_members=4))


@pytest.mark.parametrize("mode", ["w:gz", "w:bz2", "w:xz"])
def test_a_decompression_bomb_is_refused_while_it_is_unpacked(mode, tmp_path):
    files = [(tar_member(f"{k}.txt"), bytes(900_000)) for k in range(4)]
    archive = write_tar(tmp_path / "packed", files, mode)
    plain_tar = write_tar(tmp_path / "plain", files)
    assert len(unpack(plain_tar, tmp_path / "new")) == 4
    with pytest.raises(ArchiveRejected, match="it unpacks to more than"):
        unpack(archive, tmp_path / "none", replace(LIMITS, max_compression_ratio=50))


@pytest.mark.parametrize(
    ("sizes", "packed", "message"),
    [
        ((1 << 20,), 1, ""),
        ((1 << 20, 1), 1, "it unpacks to 1048577 times its size, expected at most 200"),
        ((1 << 22,), 1 << 15, ""),
        ((200 << 20,), 1 << 20, ""),
        ((200 << 20, 1), 1 << 20, "it unpacks to 200 times its size"),
        ((1 << 29, 1 << 29), 1 << 29, ""),
        ((1 << 29, 1 << 29, 1), 1 << 29, "claim 1073741825 bytes together"),
        (((1 << 29) + 1,), 1 << 29, "'0' claims 536870913 bytes"),
    ],
)
def test_an_archive_may_be_as_large_as_its_limits(sizes, packed, message):
    claimed = [Member(PurePosixPath(str(k)), size) for k, size in enumerate(sizes)]
    with pytest.raises(ArchiveRejected, match=message) if message else nullcontext():
        check_sizes(claimed, packed, LIMITS)
