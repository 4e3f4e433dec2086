"""TIFF files of other programs are read as these programs read them, or refused."""

from pathlib import Path

import numpy as np
import pytest
import tifffile
from PIL import Image

from hdrlab.errors import FileFormatError, InputError
from hdrlab.io import album, photos
from hdrlab.io.decode import read_header

CASES = Path(__file__).parents[3] / "shared/data/cases"
RGB = (
    np.random.default_rng(0)
    .integers(30, 220, (4, 6, 3), np.uint8)
    .repeat(8, axis=0)
    .repeat(8, axis=1)
)
GRAY = RGB[..., 1]
DEEP = RGB.astype(np.uint16) * 257 + 3


def read_by_pillow(path):
    """Return the pixels of the largest page, read by Pillow."""
    with Image.open(path) as image:
        return np.asarray(image)


@pytest.mark.parametrize(
    "options",
    [
        {"bigtiff": True},
        {"byteorder": ">"},
        {"bigtiff": True, "byteorder": ">"},
        {"planarconfig": "separate"},
        {"planarconfig": "separate", "tile": (16, 16), "compression": "deflate"},
        {"compression": "lzw", "predictor": True},
    ],
)
@pytest.mark.parametrize("pixels", [RGB, DEEP])
def test_layout_of_the_file_changes_no_pixel(tmp_path, pixels, options):
    path = tmp_path / "a.tif"
    is_planar = "planarconfig" in options
    stored = np.moveaxis(pixels, -1, 0) if is_planar else pixels
    tifffile.imwrite(path, stored, photometric="rgb", **options)
    np.testing.assert_array_equal(photos.read_photo(path), pixels)


@pytest.mark.parametrize("pixels", [GRAY, DEEP[..., 0]])
def test_gray_whose_zero_is_white_is_inverted(tmp_path, pixels):
    path = tmp_path / "scan.tif"
    tifffile.imwrite(path, np.iinfo(pixels.dtype).max - pixels, photometric="miniswhite")
    np.testing.assert_array_equal(photos.read_photo(path), pixels)


@pytest.mark.parametrize(
    "options",
    [{}, {"subsampling": (2, 2)}, {"subsampling": (1, 1)}, {"tile": (16, 16)}, {"rowsperstrip": 8}],
)
def test_jpeg_compression_is_decoded_as_pillow_does(tmp_path, options):
    path = tmp_path / "a.tif"
    tifffile.imwrite(path, RGB, photometric="ycbcr", compression="jpeg", **options)
    np.testing.assert_array_equal(photos.read_photo(path), read_by_pillow(path))


def test_jpeg_compression_of_rgb_with_shared_tables_is_decoded_as_pillow_does(tmp_path):
    path = tmp_path / "a.tif"
    Image.fromarray(RGB).save(path, compression="jpeg")
    np.testing.assert_array_equal(photos.read_photo(path), read_by_pillow(path))


def test_damaged_jpeg_in_a_tiff_is_refused_by_name(tmp_path):
    path = tmp_path / "broken.tif"
    noise = np.random.default_rng(1).integers(0, 256, (64, 64, 3), np.uint8)
    tifffile.imwrite(path, noise, photometric="ycbcr", compression="jpeg", rowsperstrip=64)
    with tifffile.TiffFile(path) as file:
        start = file.pages.first.dataoffsets[0]
        size = file.pages.first.databytecounts[0]
    data = bytearray(path.read_bytes())
    data[start + size // 2 : start + size - 64] = bytes(size - size // 2 - 64)
    path.write_bytes(data)
    with pytest.raises(FileFormatError, match=r"broken\.tif"):
        photos.read_photo(path)


def test_photo_behind_a_thumbnail_is_read(tmp_path):
    path = tmp_path / "scan.tif"
    with tifffile.TiffWriter(path) as file:
        file.write(RGB[::4, ::4], photometric="rgb", subfiletype=1)
        file.write(DEEP, photometric="rgb")
    np.testing.assert_array_equal(photos.read_photo(path), DEEP)


def test_photo_below_a_thumbnail_is_read(tmp_path):
    path = tmp_path / "camera.tif"
    with tifffile.TiffWriter(path) as file:
        file.write(RGB[::4, ::4], photometric="rgb", subfiletype=1, subifds=1)
        file.write(RGB, photometric="rgb")
    np.testing.assert_array_equal(photos.read_photo(path), RGB)


def test_thumbnails_and_masks_behind_the_photo_are_ignored(tmp_path):
    path = tmp_path / "scan.tif"
    with tifffile.TiffWriter(path) as file:
        file.write(RGB, photometric="rgb")
        file.write(RGB[::2, ::2], photometric="rgb", subfiletype=1)
        mask = np.zeros((99, 99), bool)
        file.write(mask, photometric="minisblack", subfiletype=4)
        file.write(255 - RGB, photometric="rgb")
    np.testing.assert_array_equal(photos.read_photo(path), RGB)


@pytest.mark.parametrize("is_thumbnail_first", [False, True])
@pytest.mark.parametrize("bigtiff", [False, True])
def test_exposure_and_orientation_are_read(tmp_path, is_thumbnail_first, bigtiff):
    path = tmp_path / "a.tif"
    tags = [(33434, "2I", 1, (1, 60), True), (274, "H", 1, 6, True)]
    with tifffile.TiffWriter(path, bigtiff=bigtiff) as file:
        if is_thumbnail_first:
            file.write(RGB[::4, ::4], photometric="rgb", subfiletype=1, extratags=tags)
            file.write(RGB, photometric="rgb")
        else:
            file.write(RGB, photometric="rgb", extratags=tags)
    header = read_header(path)
    assert header.exposure.seconds == pytest.approx(1 / 60)
    assert header.shape == (48, 32, 3)
    np.testing.assert_array_equal(photos.read_photo(path), np.rot90(RGB, -1))


@pytest.mark.parametrize(
    ("write", "reason"),
    [
        (lambda path: Image.fromarray(RGB).convert("CMYK").save(path), "CMYK"),
        (lambda path: Image.fromarray(RGB).convert("YCbCr").save(path), "YCbCr"),
        (lambda path: Image.fromarray(RGB).convert("P").save(path), "palette"),
        (lambda path: Image.fromarray(RGB).convert("LAB").save(path), "Lab"),
    ],
)
def test_other_pixels_are_refused_with_the_reason(tmp_path, write, reason):
    path = tmp_path / "other.tif"
    write(path)
    with pytest.raises(InputError, match=rf"other\.tif.*{reason}"):
        photos.read_photo(path)


@pytest.mark.parametrize("suffix", [".tif", ".jpg"])
def test_folder_of_cmyk_photos_is_refused_in_one_sentence(tmp_path, suffix):
    for name in ("a", "b", "c"):
        Image.fromarray(RGB).convert("CMYK").save(tmp_path / f"{name}{suffix}")
    with pytest.raises(InputError) as refused:
        album.select(tmp_path)
    text = str(refused.value)
    assert text.count("CMYK") == 1
    assert "print" in text
    assert f"a{suffix}" in text


def test_cmyk_photo_among_others_is_skipped_by_name(tmp_path):
    for name in ("a", "b"):
        Image.fromarray(RGB).save(tmp_path / f"{name}.tif")
    Image.fromarray(RGB).convert("CMYK").save(tmp_path / "print.tif")
    selection = album.select(tmp_path)
    assert [path.name for path in selection.paths] == ["a.tif", "b.tif"]
    assert any("print.tif" in note and "CMYK" in note for note in selection.notes)


def test_case_of_cmyk_photos_is_refused_as_cmyk():
    folder = CASES / "tiff_cmyk"
    if not folder.is_dir():
        pytest.skip("no shared data")
    with pytest.raises(InputError, match="CMYK"):
        photos.read_bracket(folder, folder / "times.txt")
