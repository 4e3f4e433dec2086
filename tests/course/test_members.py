"""Names and sizes of archive members: which ones are accepted, to the letter and to the byte."""

import io
import stat
import zipfile
from pathlib import PurePosixPath

import pytest

from hdrlab.course.submissions.archives import members
from hdrlab.course.submissions.archives.members import (
    LIMITS,
    ArchiveLimits,
    ArchiveRejected,
    Member,
)
from hdrlab.course.submissions.archives.packing import make_zip


def test_device_names_of_windows_are_refused_with_any_extension():
    ports = [f"{port}{k}" for port in ("com", "lpt") for k in "123456789"]
    for name in ["con", "prn", "aux", "nul", *ports]:
        for path in (name, f"{name.upper()}.txt", f"folder/{name}"):
            with pytest.raises(ArchiveRejected):
                members.check_names([path])


@pytest.mark.parametrize(
    "name",
    [
        "/a",
        "\\a",
        "C:/a",
        "c:",
        "a/../b",
        "..",
        "a\\..\\b",
        "a\\b",
        "a\x01b",
        "a\u200bb",
        "a\udc80b",
        "",
        ".",
        "n" * 201,
        "\u00e9" * 101,
        "/".join("abcdefghijklm"),
        "Con",
        "a/lpt9.tar.gz/b",
        "a./b",
        "a ",
        "ab:c",
    ],
)
def test_a_name_that_no_submission_needs_is_refused_and_quoted(name):
    with pytest.raises(ArchiveRejected) as refused:
        members.check_names([name])
    message = str(refused.value)
    assert members.quote_name(name) in message
    assert message.isprintable() and len(message) < 150


@pytest.mark.parametrize(
    "name",
    [
        "a",
        "..a",
        "a..b/c",
        "com0",
        "com10",
        "a.con",
        "console.txt",
        ".x",
        "\u00e9" * 100,
        "n" * 200,
        "a:"[:1] + "b",
    ],
)
def test_a_harmless_name_that_resembles_a_dangerous_one_is_accepted(name):
    assert members.check_names([name]) == [PurePosixPath(name)]
    deep = "/".join("abcdefghijkl")
    assert members.check_names([deep, "./x/./y"])[1] == PurePosixPath("x/y")


@pytest.mark.parametrize(
    ("names", "twice"),
    [
        (["a", "a"], "'a'"),
        (["a/b", "a/./b"], "'a/b'"),
        (["Ab", "aB"], "'aB'"),
        (["e\u0301", "\u00e9"], "'\u00e9'"),
        (["stra\u00dfe", "STRASSE"], "'STRASSE'"),
        (["a", "a/b"], "'a/b'"),
        (["a/b", "a"], "'a'"),
        (["a/b/c", "A/B"], "'A/B'"),
        (["a/b/c", "a"], "'a'"),
        (["x/a", "X/a/b"], "'X/a/b'"),
    ],
)
def test_names_that_are_the_same_file_on_some_system_are_refused(names, twice):
    with pytest.raises(ArchiveRejected, match="twice") as refused:
        members.check_names([*names[:1], "between", *names[1:]])
    assert twice in str(refused.value)


def test_files_may_share_their_folders():
    names = ["a/b/c", "a/b/d", "a/c", "d", "A/e"]
    assert members.check_names(names) == [PurePosixPath(name) for name in names]


def test_a_long_name_is_shown_with_its_first_sixty_letters():
    assert members.quote_name("n" * 60) == repr("n" * 60)
    assert len(members.quote_name("n" * 200)) == len(members.quote_name("n" * 61)) == 62


def test_too_many_members_are_refused_with_their_number():
    members.check_count(3, ArchiveLimits(max_members=3))
    with pytest.raises(ArchiveRejected, match="4 members.*3"):
        members.check_count(4, ArchiveLimits(max_members=3))
    with pytest.raises(ArchiveRejected, match="2 members"):
        members.check_names(["../a", "b"], ArchiveLimits(max_members=1))


def test_a_compression_ratio_that_is_too_large_is_refused_with_the_ratio():
    big = [Member(PurePosixPath("a"), (1 << 20) + 1)]
    with pytest.raises(ArchiveRejected, match="262144 times .*200"):
        members.check_sizes(big, 4, LIMITS)
    with pytest.raises(ArchiveRejected, match="1048577 times .*200"):
        members.check_sizes(big, 0, LIMITS)
    members.check_sizes([Member(PurePosixPath("a"), 1 << 20)], 0, LIMITS)
    with pytest.raises(ArchiveRejected, match="'a' .*8 .*7"):
        members.check_sizes([Member(PurePosixPath("a"), 8)], 8, ArchiveLimits(max_file_bytes=7))
    with pytest.raises(ArchiveRejected, match="14 .*13"):
        members.check_sizes(
            [Member(PurePosixPath("a"), 7)] * 2,
            8,
            ArchiveLimits(max_file_bytes=7, max_total_bytes=13),
        )


@pytest.mark.parametrize("size", [0, 1, 65535, 65536, 65537, 200_000])
def test_a_member_must_have_exactly_the_size_that_it_claims(size, tmp_path):
    data = bytes(k % 251 for k in range(size))
    members.write_member(io.BytesIO(data), tmp_path / "new" / "folder" / "a", size)
    assert (tmp_path / "new" / "folder" / "a").read_bytes() == data
    with pytest.raises(ArchiveRejected, match=f"'b' .*larger .*{size} bytes"):
        members.write_member(io.BytesIO(data + b"x"), tmp_path / "b", size)
    with pytest.raises(ArchiveRejected, match=f"'c' .*shorter .*{size + 1} bytes"):
        members.write_member(io.BytesIO(data), tmp_path / "c", size + 1)


class Endless(io.RawIOBase):
    """A stream that never ends, and counts the bytes that were read."""

    taken = 0

    def read(self, size=-1):
        self.taken += size
        return bytes(size)


def test_an_endless_member_is_read_only_until_it_exceeds_its_claimed_size(tmp_path):
    source = Endless()
    with pytest.raises(ArchiveRejected, match="larger than the 10 bytes"):
        members.write_member(source, tmp_path / "a", 10)
    assert source.taken == 11


def test_a_member_overwrites_nothing_follows_no_link_and_is_not_executable(tmp_path):
    (tmp_path / "there").write_bytes(b"old")
    (tmp_path / "link").symlink_to(tmp_path / "planted")
    for name in ("there", "link"):
        with pytest.raises(FileExistsError):
            members.write_member(io.BytesIO(b"new"), tmp_path / name, 3)
    assert (tmp_path / "there").read_bytes() == b"old" and not (tmp_path / "planted").exists()
    members.write_member(io.BytesIO(b"new"), tmp_path / "a", 3)
    assert stat.S_IMODE((tmp_path / "a").stat().st_mode) & 0o133 == 0


def test_a_packed_zip_is_reproducible_and_keeps_executable_bits():
    files = {"run": b"#!", "b.PNG": b"0" * 99, "a.txt": b"0" * 99}
    whole = make_zip(files, ["run"])
    assert whole == make_zip(dict(reversed(files.items())), ("run",))
    with zipfile.ZipFile(io.BytesIO(whole)) as opened:
        listings = [
            (entry.filename, entry.external_attr >> 16, entry.compress_type)
            for entry in opened.infolist()
        ]
        assert {entry.date_time for entry in opened.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        assert {entry.filename: opened.read(entry) for entry in opened.infolist()} == files
    assert listings == [("a.txt", 0o100644, 8), ("b.PNG", 0o100644, 0), ("run", 0o100755, 8)]
