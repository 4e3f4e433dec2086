"""A damaged JPEG is refused by name, or it decodes to exactly the pixels of the sound file."""

import io

import numpy as np
import pytest
from PIL import Image

from hdrlab.errors import FileFormatError
from hdrlab.io.photos import read_photo

SECTOR_BYTES = 512
BLOCK_BYTES = 4096
MARKER_AND_TABLES_BYTES = 700
END_OF_IMAGE = b"\xff\xd9"
RESTART_MARKERS = [bytes([0xFF, 0xD0 + number]) for number in range(8)]

WAYS_TO_ENCODE = {
    "baseline": {"subsampling": 2},
    "full color": {"subsampling": 0},
    "gray": {},
    "progressive": {"progressive": True},
    "restart markers": {"restart_marker_rows": 1},
}


def scene(gray):
    rows, columns = np.mgrid[:192, :256]
    texture = np.random.default_rng(4).normal(0, 12, (192, 256))
    red = 128 + 90 * np.sin(rows / 17 + columns / 29) + texture
    green = 128 + 80 * np.cos(rows / 23) + texture
    pixels = np.dstack([red, green, columns / 2 + 60]).clip(0, 255).astype(np.uint8)
    return pixels[..., 0] if gray else pixels


def encode(way):
    file = io.BytesIO()
    image = Image.fromarray(scene(gray=way == "gray"))
    image.save(file, "JPEG", quality=92, **WAYS_TO_ENCODE[way])
    return file.getvalue()


def replace_bytes(data, place, new):
    return data[:place] + new + data[place + len(new) :]


def at(data, share):
    """Return the position at a fraction of the coded pixels."""
    return MARKER_AND_TABLES_BYTES + int(share * (len(data) - MARKER_AND_TABLES_BYTES))


def zero_sector(share, size=SECTOR_BYTES):
    return lambda data: replace_bytes(data, at(data, share), bytes(size))


def fill_sector(share, value):
    return lambda data: replace_bytes(data, at(data, share), bytes([value]) * SECTOR_BYTES)


def cut(share):
    return lambda data: data[: at(data, share)]


def cut_and_close(share):
    return lambda data: data[: at(data, share)] + END_OF_IMAGE


def drop(share, size):
    return lambda data: data[: at(data, share)] + data[at(data, share) + size :]


def repeat(share, size):
    return lambda data: data[: at(data, share) + size] + data[at(data, share) :]


def without_middle_restart(data):
    marker = RESTART_MARKERS[5]
    return data.replace(marker, b"", 1)


DAMAGES = {
    "sector of zeros near the top": zero_sector(0.1),
    "sector of zeros in the middle": zero_sector(0.5),
    "sector of zeros near the bottom": zero_sector(0.85),
    "block of zeros": zero_sector(0.3, BLOCK_BYTES),
    "sector of ones": fill_sector(0.4, 0xFF),
    "sector of an erased flash": fill_sector(0.6, 0xAA),
    "cut at a tenth": cut(0.1),
    "cut at six tenths": cut(0.6),
    "cut before its end marker": lambda data: data[:-2],
    "cut and closed at a tenth": cut_and_close(0.1),
    "cut and closed at six tenths": cut_and_close(0.6),
    "cut and closed near the end": cut_and_close(0.97),
    "missing sector": drop(0.3, SECTOR_BYTES),
    "missing block": drop(0.5, BLOCK_BYTES),
    "repeated sector": repeat(0.5, SECTOR_BYTES),
    "repeated block": repeat(0.3, BLOCK_BYTES),
    "end marker in the middle": lambda data: replace_bytes(data, at(data, 0.5), END_OF_IMAGE),
    "no restart marker": without_middle_restart,
    "bytes after the end": lambda data: data + bytes(SECTOR_BYTES),
    "second file after the end": lambda data: data + data[:BLOCK_BYTES],
}
HARMLESS = {"bytes after the end", "second file after the end"}
# The later scans of a progressive JPEG add one bit to each coefficient: any bits are valid there.
UNDETECTABLE = {
    ("progressive", "sector of zeros near the bottom"),
    ("progressive", "sector of an erased flash"),
}
CASES = [
    (way, damage)
    for way in WAYS_TO_ENCODE
    for damage in DAMAGES
    if (way, damage) not in UNDETECTABLE
]


@pytest.mark.parametrize(("way", "damage"), CASES)
def test_damaged_jpeg_is_refused_by_name_or_has_the_pixels_of_the_sound_one(way, damage, tmp_path):
    sound = tmp_path / "sound.jpg"
    sound.write_bytes(encode(way))
    damaged = tmp_path / "damaged.jpg"
    damaged.write_bytes(DAMAGES[damage](sound.read_bytes()))
    try:
        pixels = read_photo(damaged)
    except FileFormatError as error:
        assert "damaged.jpg" in str(error)
        assert damage not in HARMLESS
    else:
        np.testing.assert_array_equal(pixels, read_photo(sound))


@pytest.mark.parametrize("way", WAYS_TO_ENCODE)
def test_sound_jpeg_has_the_pixels_that_pillow_decodes(way, tmp_path):
    path = tmp_path / "sound.jpg"
    path.write_bytes(encode(way))
    np.testing.assert_array_equal(read_photo(path), np.asarray(Image.open(path)))


def test_every_frame_of_a_cut_that_is_closed_is_refused(tmp_path):
    sound = encode("baseline")
    path = tmp_path / "cut.jpg"
    for share in np.linspace(0.05, 0.95, 19):
        path.write_bytes(cut_and_close(share)(sound))
        with pytest.raises(FileFormatError, match=r"cut\.jpg"):
            read_photo(path)
