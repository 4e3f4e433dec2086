"""Which files of a folder form the bracket: pairs, thumbnails, edited copies, rotated photos."""

import numpy as np
import pytest
from PIL import Image

from hdrlab.io.photos import read_bracket

RGB = np.random.default_rng(0).integers(20, 240, (40, 56, 3), np.uint8)
FORMATS = {"jpg": "JPEG", "webp": "WEBP", "png": "PNG"}


def tags(seconds=0.25, orientation=1):
    exif = Image.Exif()
    exif[0x010F] = "Maker"
    exif[0x0112] = orientation
    exif.get_ifd(0x8769).update({33434: seconds, 33437: 2.0, 34855: 80})
    return exif


def save(path, image=RGB, *, seconds=0.25, orientation=1):
    Image.fromarray(image).save(
        path, format=FORMATS[path.suffix[1:].lower()], exif=tags(seconds, orientation)
    )
    return path


def bracket_in(folder, times=(0.25, 1.0, 4.0), suffix="jpg", image=RGB):
    for j, t in enumerate(times):
        save(folder / f"IMG_000{j}.{suffix}", image, seconds=t)
    return folder


def read_noting(folder, *args):
    """Return a bracket and the notes about it."""
    notes = []
    return read_bracket(folder, *args, note=notes.append), notes


def test_sidecar_files_are_ignored_and_suffixes_may_be_uppercase(tmp_path):
    bracket_in(tmp_path, suffix="JPG")
    for name in (
        "IMG_0000.xmp",
        "IMG_0000.AAE",
        "IMG_0000.json",
        "IMG_0000.THM",
        "._IMG_0000.JPG",
        "IMG_0000.MOV",
    ):
        (tmp_path / name).write_bytes(b"not a photograph")
    bracket, notes = read_noting(tmp_path)
    assert len(bracket.names) == 3 and notes == []


def test_one_format_is_used_of_photos_that_exist_in_two_with_a_note(tmp_path):
    bracket_in(bracket_in(tmp_path), suffix="webp")
    (tmp_path / "IMG_0002.webp").unlink()
    bracket, notes = read_noting(tmp_path)
    assert bracket.names == ("IMG_0000.jpg", "IMG_0001.jpg", "IMG_0002.jpg")
    assert len(notes) == 1
    assert ".jpg" in notes[0]


@pytest.mark.parametrize(
    "copy", ["IMG_0001-edited", "IMG_0001_thumb", "IMG_E0001", "IMG_0001~2", "img_0001 HDR"]
)
def test_edited_copies_are_skipped_with_a_note(tmp_path, copy):
    save(bracket_in(tmp_path) / f"{copy}.jpg", 255 - RGB, seconds=1.0)
    bracket, notes = read_noting(tmp_path)
    assert len(bracket.names) == 3
    assert len(notes) == 1
    assert f"{copy}.jpg" in notes[0]
    assert "IMG_0001" in notes[0]


def test_photos_with_similar_names_are_not_skipped(tmp_path):
    for j, name in enumerate(["a", "a1", "a10", "ab", "frame", "frame hdr 2"]):
        save(tmp_path / f"{name}.jpg", seconds=2.0**j)
    bracket, notes = read_noting(tmp_path)
    assert len(bracket.names) == 6 and notes == []


def test_thumbnails_are_skipped_with_a_note(tmp_path):
    save(bracket_in(tmp_path) / "small.jpg", RGB[::4, ::4].copy(), seconds=1.0)
    bracket, notes = read_noting(tmp_path)
    assert len(bracket.names) == 3
    assert len(notes) == 1
    assert "small.jpg" in notes[0]


def test_cmyk_images_are_skipped_with_a_note(tmp_path):
    Image.fromarray(RGB).convert("CMYK").save(bracket_in(tmp_path) / "poster.jpg")
    bracket, notes = read_noting(tmp_path)
    assert len(bracket.names) == 3 and len(notes) == 1
    assert "poster.jpg" in notes[0]
    assert "CMYK" in notes[0]


def test_notes_are_warnings_by_default(tmp_path):
    save(bracket_in(tmp_path) / "small.jpg", RGB[::4, ::4].copy(), seconds=1.0)
    with pytest.warns(UserWarning, match="small.jpg"):
        read_bracket(tmp_path)


def test_odd_exif_orientation_is_replaced_by_that_of_most_frames(tmp_path):
    for j, orientation in enumerate((1, 6, 1)):
        save(tmp_path / f"{j}.png", RGB, seconds=2.0**j, orientation=orientation)
    bracket, notes = read_noting(tmp_path)
    assert all(np.array_equal(image, RGB) for image in bracket.images)
    assert len(notes) == 1
    assert "1.png" in notes[0]


def test_frames_that_were_rotated_keep_their_own_orientation(tmp_path):
    save(tmp_path / "0.png", RGB, seconds=1.0)
    save(tmp_path / "1.png", np.ascontiguousarray(np.rot90(RGB)), seconds=2.0, orientation=6)
    bracket, notes = read_noting(tmp_path)
    assert all(np.array_equal(image, RGB) for image in bracket.images) and notes == []


def test_photos_that_the_camera_merged_are_noted_in_one_line(tmp_path):
    for j in range(3):
        exif = tags(2.0**j)
        exif.get_ifd(0x8769)[0xA401] = 3
        Image.fromarray(RGB).save(tmp_path / f"{j}.jpg", exif=exif)
    _, notes = read_noting(tmp_path)
    assert len(notes) == 1
    assert notes[0].startswith("0.jpg (and 2 more) was put together by the camera out of several")


def test_error_for_a_folder_without_photos_names_its_subfolders(tmp_path):
    (tmp_path / "frames").mkdir()
    bracket_in(tmp_path / "frames")
    with pytest.raises(ValueError, match="folders frames"):
        read_bracket(tmp_path)
