"""Reading photos and writing images: other libraries read what hdrlab writes, and the reverse."""

import re
import struct
import zlib

import cv2
import imageio.v3 as iio
import numpy as np
import pytest
import tifffile
from PIL import Image, ImageOps

from hdrlab.io.decode import read_header
from hdrlab.io.photos import read_bracket, read_photo, write_picture

RNG = np.random.default_rng(0)
RGB8 = RNG.integers(0, 256, (13, 21, 3), np.uint8)
RGB16 = RNG.integers(0, 65536, (13, 21, 3), np.uint16)
IMAGES = {
    "rgb8": RGB8,
    "gray8": RGB8[..., 1].copy(),
    "rgb16": RGB16,
    "gray16": RGB16[..., 1].copy(),
}


def exif(orientation=1, *, seconds=None, f_number=None, iso=None):
    tags = Image.Exif()
    tags[0x0112] = orientation
    stated = {33434: seconds, 33437: f_number, 34855: iso}
    tags.get_ifd(0x8769).update({tag: value for tag, value in stated.items() if value is not None})
    return tags


def save(path, image, **tags):
    """Write an image with Pillow, with EXIF."""
    Image.fromarray(image).save(path, exif=exif(**tags))
    return path


def png(path, width, height, depth=8, kind=2, *chunks):
    """Write a PNG with any header and one or two pixels."""
    data = b"\x89PNG\r\n\x1a\n"
    ihdr = struct.pack(">IIBBBBB", width, height, depth, kind, 0, 0, 0)
    for name, body in (b"IHDR", ihdr), *chunks, (b"IDAT", zlib.compress(bytes(9))), (b"IEND", b""):
        data += (
            struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))
        )
    path.write_bytes(data)
    return path


@pytest.mark.parametrize("name", IMAGES)
def test_png_keeps_every_bit_that_opencv_wrote(tmp_path, name):
    image = IMAGES[name]
    cv2.imwrite(
        str(tmp_path / "x.png"),
        np.ascontiguousarray(image[..., ::-1]) if image.ndim == 3 else image,
    )
    read = read_photo(tmp_path / "x.png")
    assert read.dtype == image.dtype and np.array_equal(read, image)


@pytest.mark.parametrize("suffix", [".png", ".tif"])
@pytest.mark.parametrize(
    "image", [RGB8[::2, ::3], RGB8[::-1], RGB8.transpose(1, 0, 2), RGB8[..., 1]]
)
def test_a_view_of_an_array_is_written_like_a_copy_of_it(tmp_path, image, suffix):
    write_picture(tmp_path / f"a{suffix}", image)
    assert np.array_equal(read_photo(tmp_path / f"a{suffix}"), image)


@pytest.mark.parametrize("shape", [(1, 1), (1, 5, 3), (13, 21), (13, 21, 3), (70, 300, 3)])
def test_png_is_written_so_that_opencv_and_pillow_read_every_bit(tmp_path, shape):
    image = RNG.integers(0, 256, shape, np.uint8)
    path = tmp_path / "x.png"
    write_picture(path, image)
    read = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    assert np.array_equal(read[..., ::-1] if image.ndim == 3 else read, image)
    with Image.open(path) as opened:
        opened.verify()


@pytest.mark.parametrize("name", IMAGES)
@pytest.mark.parametrize(
    "how", [{}, {"compression": "deflate", "predictor": True}, {"byteorder": ">"}]
)
def test_tiff_keeps_every_bit(tmp_path, name, how):
    image = IMAGES[name]
    photometric = "rgb" if image.ndim == 3 else "minisblack"
    tifffile.imwrite(tmp_path / "x.tif", image, photometric=photometric, **how)
    read = read_photo(tmp_path / "x.tif")
    assert read.dtype == image.dtype and read.dtype.isnative and np.array_equal(read, image)


def test_a_tiff_of_separate_planes_reads(tmp_path):
    planes = np.moveaxis(RGB16, -1, 0)
    tifffile.imwrite(tmp_path / "x.tif", planes, photometric="rgb", planarconfig="separate")
    assert np.array_equal(read_photo(tmp_path / "x.tif"), RGB16)


@pytest.mark.parametrize("name", ["rgb8", "gray8"])
@pytest.mark.parametrize("progressive", [True, False])
def test_jpeg_decodes_as_in_pillow_and_opencv(tmp_path, name, progressive):
    Image.fromarray(IMAGES[name]).save(tmp_path / "x.jpg", quality=90, progressive=progressive)
    read = read_photo(tmp_path / "x.jpg")
    theirs = cv2.imread(str(tmp_path / "x.jpg"), cv2.IMREAD_UNCHANGED)
    assert np.array_equal(read, iio.imread(tmp_path / "x.jpg"))
    assert np.array_equal(read, theirs[..., ::-1] if read.ndim == 3 else theirs)


@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize("suffix", ["jpg", "png", "tif"])
@pytest.mark.parametrize("name", ["rgb8", "gray8"])
def test_exif_orientation_is_applied(tmp_path, orientation, suffix, name):
    path = save(tmp_path / f"x.{suffix}", IMAGES[name], orientation=orientation)
    oracle = (
        save(tmp_path / "y.png", IMAGES[name], orientation=orientation) if suffix == "tif" else path
    )
    with Image.open(oracle) as image:  # gray TIFF is turned twice by Pillow
        upright = np.asarray(ImageOps.exif_transpose(image))
    read = read_photo(path)
    assert read_header(path).shape == read.shape and np.array_equal(read, upright)


def tiff_with_exif(path):
    """Write a TIFF with EXIF in a directory of its own; neither Pillow nor tifffile can write this."""
    tifffile.imwrite(path, RGB8, photometric="rgb", extratags=[(65000, "I", 1, 0x7A7A7A7A, True)])
    data = path.read_bytes()
    at = len(data) + len(data) % 2
    entry = struct.Struct("<HHII")
    values = at + 2 + 3 * entry.size + 4
    directory = (
        struct.pack("<H", 3) + entry.pack(33434, 5, 1, values) + entry.pack(33437, 5, 1, values + 8)
    )
    directory += entry.pack(34855, 3, 1, 400) + bytes(4) + struct.pack("<4I", 1, 80, 56, 10)
    data = data.replace(
        struct.pack("<HHII", 65000, 4, 1, 0x7A7A7A7A), struct.pack("<HHII", 34665, 4, 1, at)
    )
    path.write_bytes(data.ljust(at, b"\0") + directory)
    return path


@pytest.mark.parametrize("suffix", ["jpg", "png", "tif"])
def test_exposure_is_read_from_exif_of_every_format(tmp_path, suffix):
    path = tmp_path / f"x.{suffix}"
    if suffix == "tif":
        tiff_with_exif(path)
    else:
        save(path, RGB8, seconds=0.0125, f_number=5.6, iso=400)
    assert read_header(path).exposure == pytest.approx((0.0125, 5.6, 400))
    assert np.array_equal(read_photo(path), RGB8) or suffix == "jpg"


def test_photo_with_damaged_exif_is_read(tmp_path):
    Image.fromarray(RGB8).save(tmp_path / "x.png", exif=b"Exif\0\0II*\0\xff\xff\xff\xff" + bytes(9))
    assert np.array_equal(read_photo(tmp_path / "x.png"), RGB8)
    assert read_header(tmp_path / "x.png").exposure[0] is None


def bracket_of(folder, times=(0.25, 1.0, 4.0), image=RGB8, **tags):
    for j, t in enumerate(times):
        save(folder / f"{'cab'[j]}.png", np.full_like(image, 10 * j + 1), seconds=t, **tags)
    return folder


def test_bracket_of_a_folder_is_sorted_by_exposure_time(tmp_path):
    bracket_of(tmp_path)
    for name in "list.csv", "notes.txt", "map.hdr", "map.exr", ".hidden.png":
        (tmp_path / name).write_text("not a photograph")
    (tmp_path / "folder.png").mkdir()
    bracket = read_bracket(tmp_path)
    assert bracket.names == ("c.png", "a.png", "b.png")
    assert not bracket.linear
    assert bracket.valid is None
    assert bracket.times.tolist() == [0.25, 1, 4]
    assert bracket.images[:, 0, 0, 0].tolist() == [
        1,
        11,
        21,
    ]
    assert np.array_equal(read_bracket([tmp_path]).images, bracket.images)


def test_times_in_a_sequence_are_in_the_order_of_the_paths(tmp_path):
    bracket_of(tmp_path)
    bracket = read_bracket([tmp_path / "b.png", tmp_path / "c.png"], [8, 2])
    assert bracket.names == ("c.png", "b.png") and bracket.times.tolist() == [2, 8]


def test_list_of_times_takes_precedence_over_exif(tmp_path):
    bracket_of(tmp_path)
    (tmp_path / "times.txt").write_text("a.png 1\nb.png 2\nc.png 4\n")
    assert read_bracket(tmp_path, tmp_path / "times.txt").names == ("c.png", "b.png", "a.png")


def test_aperture_and_iso_change_the_equivalent_exposure(tmp_path):
    save(tmp_path / "a.jpg", RGB8, seconds=0.5, f_number=8.0, iso=100)
    save(tmp_path / "b.jpg", RGB8, seconds=0.5, f_number=4.0, iso=200)
    assert read_bracket(tmp_path).times == pytest.approx([0.5, 4])


def test_the_luminance_of_a_unit_is_what_an_exposure_meter_reads(tmp_path):
    """The meter's formula L = 12.5 N^2 / (t S), with the f-number and ISO of the first photo."""
    save(tmp_path / "a.jpg", RGB8, seconds=0.5, f_number=8.0, iso=100)
    save(tmp_path / "b.jpg", RGB8, seconds=0.5, f_number=4.0, iso=200)
    bracket = read_bracket(tmp_path)
    assert bracket.luminance_of_unit == pytest.approx(12.5 * 8**2 / 100)
    assert bracket.max_luminance_of_unit is None
    assert read_bracket(tmp_path, [1, 2]).luminance_of_unit is None


@pytest.mark.parametrize(("f_number", "iso"), [(4.0, None), (None, 400), (None, None)])
def test_the_luminance_of_a_unit_has_an_upper_bound_if_iso_or_f_number_is_missing(
    tmp_path, f_number, iso
):
    """Cameras at ISO 100 or more with f/11 or less, by the same formula."""
    bracket_of(tmp_path, f_number=f_number, iso=iso)
    bracket = read_bracket(tmp_path)
    assert bracket.luminance_of_unit is None
    largest = 12.5 * (f_number or 11) ** 2 / (iso or 100)
    assert bracket.max_luminance_of_unit == pytest.approx(largest)
    # a list may have relative times, such as 1, 2 and 4
    assert read_bracket(tmp_path, [1, 2, 4]).max_luminance_of_unit is None


@pytest.mark.parametrize("f_number", [0.0, None])
def test_f_number_of_0_or_infinity_is_ignored(tmp_path, f_number):
    bracket_of(tmp_path, f_number=f_number, iso=100)
    assert read_bracket(tmp_path).times.tolist() == [0.25, 1, 4]


def test_pixels_of_the_mask_color_are_not_valid(tmp_path):
    image = RGB8.copy()
    image[2:5, 3:9] = (0, 0, 255)
    for name in "ab":
        save(tmp_path / f"{name}.png", image)
    valid = read_bracket(tmp_path, [1, 2], mask=(0, 0, 255)).valid
    expected = np.ones(RGB8.shape[:2], bool)
    expected[2:5, 3:9] = False
    assert valid.shape == (2, 13, 21) and np.array_equal(valid[0], expected)


def test_mask_color_is_rejected_for_gray_photos(tmp_path):
    bracket_of(tmp_path, image=RGB8[..., 0])
    with pytest.raises(ValueError, match=r"\(0, 0, 255\).*gray"):
        read_bracket(tmp_path, mask=(0, 0, 255))


def test_progress_iterates_over_each_photo_once(tmp_path):
    seen = []

    def watch(paths):
        for path in paths:
            yield path
            seen.append(path.name)

    read_bracket(bracket_of(tmp_path), progress=watch)
    assert sorted(seen) == ["a.png", "b.png", "c.png"]


def test_error_names_a_folder_without_photos(tmp_path):
    (tmp_path / "list.csv").write_text("file,exposure_time_s\n")
    with pytest.raises(ValueError, match=re.escape(str(tmp_path))):
        read_bracket(tmp_path)


def test_bracket_of_one_photo_is_rejected(tmp_path):
    path = save(tmp_path / "a.jpg", RGB8, seconds=1.0)
    for paths in path, [path], tmp_path:
        with pytest.raises(ValueError, match="photographs.*a.jpg"):
            read_bracket(paths)
    with pytest.raises(ValueError, match="photographs.*none"):
        read_bracket([])


def test_missing_photo_raises_file_not_found_error(tmp_path):
    path = save(tmp_path / "a.jpg", RGB8, seconds=1.0)
    with pytest.raises(FileNotFoundError, match="b.jpg"):
        read_bracket([path, tmp_path / "b.jpg"])


def test_folder_among_photos_is_rejected(tmp_path):
    with pytest.raises(ValueError, match=re.escape(str(tmp_path))):
        read_bracket([tmp_path, tmp_path])


@pytest.mark.parametrize(
    ("first", "second", "says"),
    [
        (RGB8, RGB8[:, 1:], "frames of one size: a.png is 21 x 13, .*, b.png is 20 x 13"),
        (RGB8, RGB8[..., 0], "all gray or all RGB.*a.png is .* RGB, .*b.png is .* gray"),
        (RGB16, RGB8, "8 or all of 16 bits.*a.png is .* 16 bits, .*b.png is .* 8 bits"),
    ],
)
def test_error_names_both_frames_that_do_not_match(tmp_path, first, second, says):
    for name, image in ("a.png", first), ("b.png", second):
        cv2.imwrite(str(tmp_path / name), np.ascontiguousarray(image))
    with pytest.raises(ValueError, match=says):
        read_bracket(tmp_path, [1, 2])


@pytest.mark.parametrize("missing", [None, 0.0])
def test_a_photo_without_exposure_time_makes_all_times_equal_with_a_note(tmp_path, missing):
    save(tmp_path / "a.jpg", RGB8, seconds=1.0)
    save(tmp_path / "b.jpg", RGB8, seconds=missing)
    notes = []
    assert read_bracket(tmp_path, note=notes.append).times.tolist() == [1, 1]
    assert "b.jpg" in notes[0] and "a.jpg" not in notes[0] and "--times" in notes[0]


def test_exposure_times_are_read_from_file_names(tmp_path):
    for name in ("1_250", "1_60", "0.1s"):
        save(tmp_path / f"{name}.jpg", RGB8)
    notes = []
    bracket = read_bracket(tmp_path, note=notes.append)
    assert bracket.times == pytest.approx([1 / 250, 1 / 60, 0.1])
    assert len(notes) == 1


@pytest.mark.parametrize("names", [("1_1", "1_2", "1_3", "1_4", "1_5"), ("IMG_1", "IMG_250")])
def test_numbers_of_photos_are_no_exposure_times(tmp_path, names):
    for name in names:
        save(tmp_path / f"{name}.jpg", RGB8)
    notes = []
    assert np.ptp(read_bracket(tmp_path, note=notes.append).times) == 0


def test_a_list_of_bare_numbers_belongs_to_the_photos_sorted_by_name(tmp_path):
    for name in "abc":
        save(tmp_path / f"{name}.jpg", RGB8)
    (tmp_path / "times.txt").write_text("0.5\n1/8\n2\n")
    notes = []
    bracket = read_bracket(tmp_path, tmp_path / "times.txt", note=notes.append)
    assert dict(zip(bracket.names, bracket.times, strict=True)) == {
        "b.jpg": 1 / 8,
        "a.jpg": 0.5,
        "c.jpg": 2,
    }
    assert len(notes) == 1
    (tmp_path / "times.txt").write_text("0.5\n2\n")
    with pytest.raises(ValueError, match="times.txt.*3 exposure times"):
        read_bracket(tmp_path, tmp_path / "times.txt", note=notes.append)


@pytest.mark.parametrize("missing", ["f_number", "iso"])
def test_what_one_photo_does_not_state_is_taken_from_all_others(tmp_path, missing):
    stated = {"f_number": 4.0, "iso": 200}
    for name, seconds in ("a", 1.0), ("b", 2.0), ("c", 4.0):
        tags = stated | ({missing: None} if name == "b" else {})
        save(tmp_path / f"{name}.jpg", RGB8, seconds=seconds, **tags)
    notes = []
    assert read_bracket(tmp_path, note=notes.append).times.tolist() == [1, 2, 4]
    assert len(notes) == 1 and "b.jpg" in notes[0]


@pytest.mark.parametrize(
    ("mode", "suffix", "says"),
    [
        ("P", "png", "a palette"),
        ("RGBA", "png", "an alpha channel with transparent"),
        ("LA", "png", "an alpha channel with transparent"),
        ("1", "png", "1-bit pixels"),
        ("CMYK", "jpg", "CMYK, for print"),
        ("P", "tif", "a palette"),
        ("RGBA", "tif", "an alpha channel with transparent"),
        ("CMYK", "tif", "CMYK, for print"),
        ("1", "tif", "bool|1-bit"),
        ("F", "tif", "float32"),
        ("YCbCr", "tif", "YCbCr"),
    ],
)
def test_unsupported_pixel_types_are_rejected_by_name(tmp_path, mode, suffix, says):
    path = tmp_path / f"x.{suffix}"
    image = Image.fromarray(RGB8).convert(mode)
    if mode.endswith("A"):
        image.putalpha(128)
    image.save(path)
    with pytest.raises(ValueError, match=f"x.{suffix}: .*({says})"):
        read_photo(path)


def test_unsupported_tiff_and_png_files_are_rejected_by_name(tmp_path):
    tifffile.imwrite(tmp_path / "x.tif", RGB8.astype(np.float32), photometric="rgb")
    with pytest.raises(ValueError, match="x.tif: .*gray or RGB of 8 or 16 bits.*3 x float32, RGB"):
        read_photo(tmp_path / "x.tif")
    path = png(tmp_path / "x.png", 1, 1, 8, 2, (b"tRNS", bytes(6)))
    with pytest.raises(ValueError, match="x.png: .*gray or RGB of 8 or 16 bits.*alpha channel"):
        read_photo(path)
    path = png(tmp_path / "x.png", 1, 1, 4, 0)
    with pytest.raises(ValueError, match="x.png: .*gray or RGB of 8 or 16 bits.*4-bit pixels"):
        read_photo(path)


@pytest.mark.parametrize(
    "data", [b"", b"GIF89a", b"#?RADIANCE\n", b"a text that is longer than any header is"]
)
def test_other_files_are_rejected_as_photos_by_name(tmp_path, data):
    (tmp_path / "x.jpg").write_bytes(data)
    with pytest.raises(ValueError, match="x.jpg: .*photograph .TIFF, JPEG, PNG, .* got b"):
        read_photo(tmp_path / "x.jpg")


@pytest.mark.parametrize("suffix", ["jpg", "png", "tif"])
def test_truncated_photos_are_rejected(tmp_path, suffix):
    path = tmp_path / f"x.{suffix}"
    write_picture(path, RNG.integers(0, 256, (60, 80, 3), np.uint8))
    data = path.read_bytes()
    # of a PNG without its last mark all pixels are there
    last = len(data) - (2 if suffix == "jpg" else 13)
    for length in (*range(1, last, 501), last):
        path.write_bytes(data[:length])
        with pytest.raises(ValueError, match=f"x.{suffix}: "):
            read_photo(path)


def test_truncated_jpeg_with_an_exif_thumbnail_is_rejected(tmp_path):
    Image.fromarray(RGB8).save(tmp_path / "x.jpg", exif=b"Exif\0\0" + b"\xff\xd8\xff\xda\xff\xd9")
    data = (tmp_path / "x.jpg").read_bytes()
    (tmp_path / "x.jpg").write_bytes(data[:-20])
    with pytest.raises(ValueError, match="x.jpg: it is cut short or damaged"):
        read_photo(tmp_path / "x.jpg")


@pytest.mark.parametrize(
    ("width", "height"), [(65536, 32768), (2**31 - 1, 1), (30000, 3000), (12000, 11000)]
)
def test_header_with_an_absurd_size_allocates_no_memory(tmp_path, width, height):
    with pytest.raises(ValueError, match="x.png: its header claims"):
        read_photo(png(tmp_path / "x.png", width, height))
    tifffile.imwrite(tmp_path / "x.tif", RGB8, photometric="rgb")
    data = (tmp_path / "x.tif").read_bytes()
    for tag, old, new in (256, 21, width), (257, 13, height):
        data = data.replace(
            struct.pack("<HHII", tag, 4, 1, old), struct.pack("<HHII", tag, 4, 1, new)
        )
        data = data.replace(
            struct.pack("<HHIHH", tag, 3, 1, old, 0), struct.pack("<HHII", tag, 4, 1, new)
        )
    (tmp_path / "x.tif").write_bytes(data)
    with pytest.raises(ValueError, match="x.tif: its header claims"):
        read_photo(tmp_path / "x.tif")


@pytest.mark.parametrize("suffix", ["png", "tif", "tiff"])
@pytest.mark.parametrize("name", ["rgb8", "gray8"])
def test_pictures_survive_a_round_trip(tmp_path, suffix, name):
    write_picture(tmp_path / f"x.{suffix}", IMAGES[name])
    assert np.array_equal(read_photo(tmp_path / f"x.{suffix}"), IMAGES[name])
    assert np.array_equal(iio.imread(tmp_path / f"x.{suffix}"), IMAGES[name])


def test_written_jpeg_is_close_to_the_picture(tmp_path):
    smooth = cv2.GaussianBlur(RGB8, (0, 0), 3)
    write_picture(tmp_path / "x.JPG", smooth)
    assert np.abs(read_photo(tmp_path / "x.JPG").astype(int) - smooth).max() <= 4


@pytest.mark.parametrize(
    ("name", "image"),
    [("x.png", RGB16), ("x.png", RGB8[..., :2]), ("x.png", RGB8[:0]), ("x.bmp", RGB8), ("x", RGB8)],
)
def test_write_picture_rejects_other_arrays_and_suffixes(tmp_path, name, image):
    with pytest.raises(ValueError, match="picture"):
        write_picture(tmp_path / name, image)
    assert not list(tmp_path.iterdir())


@pytest.mark.papers
@pytest.mark.parametrize(
    ("name", "frames"), [("window", 12), ("stlouis_arch", 4), ("frobisher", 3)]
)
def test_real_brackets_have_the_times_of_their_exif(shared, name, frames):
    folder = shared(name)
    bracket = read_bracket(folder)
    listed = read_bracket(folder, folder / "exposures.csv")
    assert len(bracket.images) == frames and bracket.names == listed.names
    assert bracket.times == pytest.approx(listed.times, rel=1e-3)
    theirs = cv2.imread(str(folder / bracket.names[0]))
    assert np.array_equal(bracket.images[0], theirs[..., ::-1])


def test_the_memorial_bracket_has_its_blue_border_masked(shared):
    folder = shared("memorial")
    bracket = read_bracket(folder, folder / "memorial.hdr_image_list.txt", mask=(0, 0, 255))
    assert bracket.images.shape == (16, 768, 512, 3) and bracket.names[0] == "memorial0076.png"
    assert np.all((bracket.images == (0, 0, 255)).all(axis=-1) == ~bracket.valid)
    assert not bracket.valid.all()


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".tif"])
def test_a_result_is_skipped_among_photos_and_has_the_pixels_of_any_picture(tmp_path, suffix):
    for name, level in ("a", 50), ("b", 200):
        write_picture(tmp_path / f"{name}{suffix}", np.full((20, 30, 3), level, np.uint8))
    write_picture(tmp_path / f"c{suffix}", np.full((20, 30, 3), 90, np.uint8), is_result=True)
    details = []
    bracket = read_bracket(tmp_path, [1, 4], detail=details.append)
    assert bracket.names == (f"a{suffix}", f"b{suffix}")
    assert f"c{suffix}" in details[0]
    assert np.abs(read_photo(tmp_path / f"c{suffix}").astype(int) - 90).max() <= 1
