"""Files that claim more than they contain are refused with a message, and nothing is changed."""

import io
import sys
import threading
import tracemalloc

import numpy as np
import OpenEXR
import pytest
import tifffile
from PIL import Image

from hdrlab import cli
from hdrlab.core import gamut
from hdrlab.errors import InputError
from hdrlab.fast.merge import merge
from hdrlab.io import codecs, files, photos, radiance, times, web
from hdrlab.io.maps import exr, rgbe

LEVELS = np.arange(256)


def two_parts(path):
    """Write a file of two parts, of which the first has damaged pixels."""
    noise = np.random.default_rng(1).integers(0, 4, (64, 80, 3)).astype(np.float32)
    kind = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    parts = [OpenEXR.Part(dict(kind), {"RGB": noise + k}, name) for k, name in enumerate("ab")]
    with OpenEXR.File(parts) as file:
        file.write(str(path))
    data = bytearray(path.read_bytes())
    data[len(data) // 4 : len(data) // 4 + 200] = bytes(200)
    path.write_bytes(data)


@pytest.mark.parametrize("read", [exr.read, exr.read_dtypes])
def test_second_part_of_an_exr_does_not_replace_a_damaged_first_part(tmp_path, read):
    two_parts(tmp_path / "parts.exr")
    with pytest.raises(ValueError, match=r"parts\.exr: .*OpenEXR file is cut short or damaged"):
        read(tmp_path / "parts.exr")


def test_huge_display_window_is_rejected_and_a_border_is_not(tmp_path):
    for rows, refused in ((300, False), (1_000_000, True)):
        window = (np.array([0, 0], np.int32), np.array([16, rows], np.int32))
        header = {
            "type": OpenEXR.scanlineimage,
            "compression": OpenEXR.NO_COMPRESSION,
            "displayWindow": window,
        }
        with OpenEXR.File(header, {"Y": np.ones((12, 17), np.float32)}) as file:
            file.write(str(tmp_path / "window.exr"))
        if refused:
            with pytest.raises(ValueError, match="display window"):
                exr.read(tmp_path / "window.exr")
        else:
            assert exr.read(tmp_path / "window.exr").shape == (rows + 1, 17)


def test_reading_exr_files_in_threads_restores_stdout(tmp_path):
    radiance.write_radiance(tmp_path / "one.exr", np.ones((40, 50, 3)))
    stream = sys.stdout
    before = threading.active_count()

    def read():
        for _ in range(20):
            exr.read(tmp_path / "one.exr")

    threads = [threading.Thread(target=read) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sys.stdout is stream and threading.active_count() == before


def test_sanitize_gives_finite_values_near_the_largest_float32():
    E = np.full((9, 9, 3), 3e38, np.float32)
    E[4, 4] = np.nan
    E[2, 2, 0] = -3e38
    E[6, 6] = np.inf
    assert np.isfinite(gamut.sanitize(E).E).all() and gamut.sanitize(E).E.min() >= 0


def test_lists_of_times_may_be_long_but_not_their_lines(tmp_path):
    file = tmp_path / "times.txt"
    file.write_text("".join(f"f{j}.jpg 1/{j + 1}\n" for j in range(3000)))
    assert len(times.read_times(file).seconds) == 3000
    file.write_text("a.jpg," + "1" * 200_000)
    with pytest.raises(ValueError, match=r"times\.txt, line 1: .* 200006 characters"):
        times.read_times(file)


def test_error_for_damage_at_the_end_of_rgbe_names_the_file(tmp_path):
    file = tmp_path / "end.hdr"
    rgbe.write(file, np.random.default_rng(0).random((20, 30, 3)))
    file.write_bytes(file.read_bytes() + bytes(50))
    with pytest.raises(ValueError, match=r"end\.hdr: .*20 scanlines"):
        rgbe.read(file)


def test_messages_contain_no_control_characters_and_are_short(tmp_path, capsys):
    (tmp_path / "a.hdr").write_bytes(b"#?RADIANCE\nFORMAT=\x1b]0;owned\x07red\n\n-Y 1 +X 1\n")
    for command in (
        ["info", tmp_path / "a.hdr"],
        ["assemble", tmp_path, "-o", "\x1b[31m.hdr", "--mask", "z" * 9000],
    ):
        with pytest.raises(SystemExit):
            cli.run([str(argument) for argument in command])
        message = capsys.readouterr().err
        assert "\x1b" not in message and "\x07" not in message and len(message) < 2100


@pytest.mark.parametrize("suffix", [".pfm", ".exr"])
def test_convert_accepts_an_all_black_map(tmp_path, capsys, suffix):
    radiance.write_radiance(tmp_path / "black.pfm", np.zeros((20, 30, 3)))
    with pytest.raises(SystemExit) as stop:
        cli.run(["convert", str(tmp_path / "black.pfm"), "-o", str(tmp_path / f"out{suffix}")])
    assert not stop.value.code and "30 x 20, all black" in capsys.readouterr().out


def test_error_for_a_full_disk_names_the_file(tmp_path, monkeypatch):
    def full(*_, **__):
        raise OSError(28, "No space left on device")

    with (
        pytest.raises(OSError, match="No space left") as stop,
        files.replacing(tmp_path / "room.pfm"),
    ):
        full()
    assert stop.value.filename == str(tmp_path / "room.pfm")
    monkeypatch.setattr(
        OpenEXR.File, "write", lambda *_: (_ for _ in ()).throw(RuntimeError("disk"))
    )
    with pytest.raises(OSError, match=r"disk may be full.*room\.exr"):
        exr.write(tmp_path / "room.exr", np.ones((4, 5, 3)))
    assert not list(tmp_path.iterdir())


def test_decode_picture_accepts_only_web_formats():
    shown = io.BytesIO()
    Image.new("RGB", (4, 3), (9, 8, 7)).save(shown, "TIFF")
    with pytest.raises(OSError, match="cannot identify"):
        web.decode_picture(shown.getvalue())
    assert web.decode_picture(web.encode_webp(np.zeros((4, 5, 3), np.uint8))).shape == (4, 5, 3)


def test_photo_that_does_not_fit_into_memory_is_an_error_that_names_it(tmp_path, monkeypatch):
    photos.write_picture(tmp_path / "a.png", np.zeros((4, 5, 3), np.uint8))
    monkeypatch.setitem(codecs.DECODERS, "PNG", lambda *_: (_ for _ in ()).throw(MemoryError()))
    with pytest.raises(ValueError, match=r"a\.png: .* memory"):
        photos.read_photo(tmp_path / "a.png")


@pytest.mark.parametrize(
    "g",
    [
        np.linspace(-5, 2, 100),
        np.linspace(2, -5, 256),
        np.linspace(-5, 2, 256) + 1j,
        np.linspace(-5, 95, 256),
        np.ma.masked_array(np.linspace(-5, 2, 256), LEVELS > 200),
        np.linspace(-5, 2, 256).astype(object),
    ],
    ids=["a hundred levels", "falling", "complex", "beyond float32", "masked", "objects"],
)
def test_merge_rejects_invalid_responses(g):
    with pytest.raises(InputError):
        merge(np.zeros((2, 4, 5), np.uint8), [0.1, 1], g)


def test_tiff_tile_far_larger_than_the_image_is_rejected_before_memory_is_allocated(tmp_path):
    path = tmp_path / "tile.tif"
    tifffile.imwrite(
        path, np.zeros((24, 34, 3), np.uint8), photometric="rgb", tile=(16, 16), compression="zlib"
    )
    with tifffile.TiffFile(path, mode="r+b") as file:
        file.pages.first.tags["TileWidth"].overwrite(1 << 24)
    tracemalloc.start()
    with pytest.raises(ValueError, match=r"tile\.tif: .* damaged"):
        photos.read_photo(path)
    assert tracemalloc.get_traced_memory()[1] < 50e6
    tracemalloc.stop()


@pytest.mark.parametrize("exposure", ["1e-320", "1e300"])
def test_rgbe_exposure_beyond_float32_is_rejected(tmp_path, exposure):
    path = tmp_path / "a.hdr"
    path.write_bytes(
        f"#?RADIANCE\nEXPOSURE={exposure}\n\n-Y 1 +X 1\n".encode() + bytes([9, 9, 9, 128])
    )
    with pytest.raises(ValueError, match=r"a\.hdr: .*positive exposures"):
        rgbe.read(path)


def test_errors_for_lists_of_times_are_short(tmp_path):
    path = tmp_path / "times.txt"
    for line in ("a.jpg " + "9" * 5000, "a.jpg 1 " + "8" * 3000 + " 9 9", "a.jpg 3[" + "[" * 3000):
        path.write_text(line)
        with pytest.raises(ValueError, match=r"times\.txt, line 1") as error:
            times.read_times(path)
        assert len(str(error.value)) < 500
