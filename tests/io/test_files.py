"""Files are written completely or not at all, and headers are validated."""

import os
import stat

import pytest

from hdrlab.errors import FileFormatError
from hdrlab.io import files, photos, radiance, response_files, times


def test_file_appears_under_its_name_when_it_is_complete(tmp_path):
    path = tmp_path / "out.hdr"
    with files.replacing(path) as name:
        name.write_bytes(b"whole")
        assert name.parent == tmp_path and name.suffix == ".hdr" and not path.exists()
    assert path.read_bytes() == b"whole" and os.listdir(tmp_path) == ["out.hdr"]


@pytest.mark.parametrize("error", [ValueError, OSError, KeyboardInterrupt])
def test_failed_or_interrupted_write_keeps_the_old_file_and_no_temporary_file(tmp_path, error):
    path = tmp_path / "out.hdr"
    path.write_bytes(b"old")
    with pytest.raises(error), files.replacing(path) as name:
        name.write_bytes(b"half of the ne")
        raise error
    assert path.read_bytes() == b"old" and os.listdir(tmp_path) == ["out.hdr"]


def test_missing_folder_is_reported_before_anything_is_written(tmp_path):
    with (
        pytest.raises(FileNotFoundError, match="no folder .*missing"),
        files.replacing(tmp_path / "missing/out.hdr"),
    ):
        pytest.fail("the block ran")


def test_folder_is_not_replaced_by_a_file(tmp_path):
    with pytest.raises(ValueError, match="name .*file"), files.replacing(tmp_path):
        pytest.fail("the block ran")


def test_device_is_not_replaced_by_a_file():
    with (
        pytest.raises(ValueError, match="name .*file"),
        files.replacing(os.devnull),
    ):
        pytest.fail("the block ran")


def test_writing_through_a_link_replaces_its_target(tmp_path):
    (tmp_path / "target.txt").write_text("old")
    (tmp_path / "link.txt").symlink_to("target.txt")
    with files.replacing(tmp_path / "link.txt") as name:
        name.write_text("new")
    assert (tmp_path / "link.txt").is_symlink() and (tmp_path / "target.txt").read_text() == "new"


def test_new_file_has_default_permissions(tmp_path):
    (tmp_path / "plain.txt").write_text("")
    with files.replacing(tmp_path / "ours.txt") as name:
        name.write_text("")
    modes = {stat.S_IMODE((tmp_path / n).stat().st_mode) for n in ("plain.txt", "ours.txt")}
    assert len(modes) == 1


def test_check_size_rejects_sizes_beyond_the_limit_or_the_file(tmp_path):
    path = tmp_path / "small.bin"
    path.write_bytes(bytes(100))
    files.check_size(path, 10, 10, 100)
    with pytest.raises(ValueError, match="small.bin.*at least one"):
        files.check_size(path, 0, 10)
    with pytest.raises(ValueError, match=r"claims 65536 x 32768 pixels, .*at most"):
        files.check_size(path, 32768, 65536)
    with pytest.raises(ValueError, match="need 101 bytes or more.*100"):
        files.check_size(path, 10, 10, 101)


def test_reserve_reports_only_a_full_disk(tmp_path, monkeypatch):
    def refuse(number):
        def fallocate(*_):
            raise OSError(number, os.strerror(number))

        return fallocate

    with open(tmp_path / "x", "wb") as file:
        monkeypatch.setattr(os, "posix_fallocate", refuse(95), raising=False)
        files.reserve(file, 10)
        monkeypatch.setattr(os, "posix_fallocate", refuse(28), raising=False)
        with pytest.raises(OSError, match="space"):
            files.reserve(file, 10)


@pytest.mark.parametrize(
    ("name", "read"),
    [
        ("x.jpg", photos.read_photo),
        ("x.dng", photos.read_photo),
        ("x.hdr", radiance.read_radiance),
        ("x.exr", radiance.read_radiance),
        ("x.csv", times.read_times),
        ("x.csv", response_files.read_curve),
    ],
)
def test_readers_reject_a_folder_with_the_name_of_a_file(name, read, tmp_path):
    (tmp_path / name).mkdir()
    with pytest.raises(FileFormatError, match=rf"{name}: .*folder"):
        read(tmp_path / name)
