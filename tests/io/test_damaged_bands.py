"""A photo with missing rows is left out; sound photos with constant rows are not."""

import numpy as np
import pytest
import tifffile

from hdrlab.io.damaged_bands import find_damaged_bands
from hdrlab.io.photos import read_bracket

TIMES = np.array([1 / 64, 1 / 16, 1 / 4, 1.0])


def make_scene():
    """Return light (120, 160, 3) that gets darker from top to bottom, with texture."""
    rng = np.random.default_rng(5)
    texture = np.exp(rng.normal(0, 0.7, (30, 40, 3))).repeat(4, axis=0).repeat(4, axis=1)
    return texture * np.geomspace(4, 0.2, 120)[:, None, None]


def shoot(light, times=TIMES):
    exposures = np.clip(light * np.reshape(times, (-1, 1, 1, 1)), 0, 1)
    return np.rint(255 * exposures ** (1 / 2.2)).astype(np.uint8)


@pytest.mark.parametrize("value", [0, 128, 255])
@pytest.mark.parametrize("frame", range(4))
def test_missing_rows_are_found_in_the_photo_that_lacks_them(frame, value):
    images = shoot(make_scene())
    images[frame, 70:] = value
    bands = find_damaged_bands(images)
    assert all(band.frame == frame for band in bands)
    if (frame, value) not in ((0, 0), (3, 255)):  # there, dark or bright rows may be true
        assert [(band.start, band.stop) for band in bands] == [(70, 120)]


def test_missing_rows_are_found_with_wrong_times():
    images = shoot(make_scene())[[2, 0, 3, 1]]
    images[1, 20:50] = 128
    assert [band.frame for band in find_damaged_bands(images)] == [1]


DAMAGED_ROWS = slice(40, 76)


def shift_rows(images, frame):
    """Return photos of which one has rows that are shifted to the side."""
    shifted = images.copy()
    shifted[frame, DAMAGED_ROWS] = np.roll(shifted[frame, DAMAGED_ROWS], 31, axis=1)
    return shifted


def overwrite_rows(images, frame):
    """Return photos of which one has rows of noise."""
    noise = images.copy()
    shape = noise[frame, DAMAGED_ROWS].shape
    noise[frame, DAMAGED_ROWS] = np.random.default_rng(2).integers(0, 256, shape)
    return noise


def assert_damage_is_found(images, frame):
    (band,) = find_damaged_bands(images)
    assert band.frame == frame
    assert abs(band.start - DAMAGED_ROWS.start) <= 4
    assert abs(band.stop - DAMAGED_ROWS.stop) <= 4


@pytest.mark.parametrize("frame", range(4))
@pytest.mark.parametrize("damage", [shift_rows, overwrite_rows])
def test_rows_that_are_shifted_or_noise_are_found_in_the_photo_that_has_them(damage, frame):
    assert_damage_is_found(damage(shoot(make_scene()), frame), frame)


def move_camera(images):
    """Return photos of a camera in the hand, (P, h, w, 3)."""
    offsets = [(0, 0), (3, -2), (-2, 4), (4, 3)]
    return np.stack(
        [
            np.roll(image, offset, axis=(0, 1))[6:-6, 6:-6]
            for image, offset in zip(images, offsets, strict=True)
        ]
    )


# Shifted rows in photo 1 are not found: its neighbor is half clipped, and seems to have moved with them.
@pytest.mark.parametrize(
    ("damage", "frame"),
    [*((shift_rows, frame) for frame in (0, 2, 3)), *((overwrite_rows, j) for j in range(4))],
)
def test_damaged_rows_are_found_also_where_the_camera_moved(damage, frame):
    sound = move_camera(shoot(make_scene()))
    assert find_damaged_bands(sound) == []
    assert_damage_is_found(damage(sound, frame), frame)


@pytest.mark.parametrize("move", [np.asarray, move_camera])
def test_clouds_above_a_straight_horizon_are_not_suspected(move):
    rng = np.random.default_rng(6)
    images = shoot(make_scene())
    for image in images:
        clouds = rng.uniform(0.4, 1.0, (10, 20, 1)).repeat(5, axis=0)
        clouds = clouds.repeat(-(-image.shape[1] // 20), axis=1)[:, : image.shape[1]]
        image[:50] = image[:50] * clouds
    assert find_damaged_bands(move(images)) == []


def test_water_that_moves_in_all_photos_and_things_that_move_are_not_suspected():
    rng = np.random.default_rng(3)
    sea = []
    for time in TIMES:
        light = make_scene()
        light[80:] *= np.exp(rng.normal(0, 0.7, (20, 80, 1))).repeat(2, axis=0).repeat(2, axis=1)
        sea.append(shoot(light, [time])[0])
    assert find_damaged_bands(np.stack(sea)) == []
    images = shoot(make_scene())
    images[1, 30:80, 20:100] = np.roll(images[1, 30:80, 20:100], 23, axis=1)
    assert find_damaged_bands(images) == []


def test_flicker_that_fades_from_row_to_row_is_not_suspected():
    light = np.stack([make_scene()] * 4)
    light[0] *= (1 + 0.5 * np.sin(np.arange(120) / 15))[:, None, None]
    images = np.stack([shoot(light[j], TIMES[j : j + 1])[0] for j in range(4)])
    assert find_damaged_bands(images) == []


@pytest.mark.parametrize("times", [TIMES, TIMES * 16, TIMES / 16])
def test_sound_photos_are_not_suspected(times):
    scene = make_scene()
    sky = scene.copy()
    sky[:60] = 50.0
    letterbox = scene.copy()
    letterbox[:20] = 0
    letterbox[-20:] = 0
    night = scene.copy()
    night[60:] = 1e-6
    for light in (scene, sky, letterbox, night, 1 / (scene + 1e-3)):
        assert find_damaged_bands(shoot(light, times)) == []


def test_sound_photos_of_a_camera_or_a_thing_that_moves_are_not_suspected():
    scene = make_scene()
    scene[:50] = 50.0
    moved = np.stack([shoot(np.roll(scene, 3 * j, axis=1), TIMES[j])[0] for j in range(4)])
    assert find_damaged_bands(moved) == []
    images = shoot(scene)
    images[2, 60:, 30:100] = 200
    assert find_damaged_bands(images) == []


def test_photo_with_missing_rows_is_left_out_with_a_warning(tmp_path):
    for j, image in enumerate(shoot(make_scene())):
        tifffile.imwrite(tmp_path / f"{j}.tif", image, photometric="rgb")
    data = (tmp_path / "1.tif").read_bytes()
    (tmp_path / "1.tif").write_bytes(data[: len(data) // 2] + bytes(len(data) - len(data) // 2))
    warnings = []
    bracket = read_bracket(tmp_path, list(TIMES), note=lambda text: None, warn=warnings.append)
    assert bracket.names == ("0.tif", "2.tif", "3.tif")
    assert len(warnings) == 1
    assert "1.tif" in warnings[0]
    assert bracket.damaged == tuple(warnings)


def test_photo_with_overwritten_rows_is_left_out_with_a_warning(tmp_path):
    for j, image in enumerate(shoot(make_scene())):
        tifffile.imwrite(tmp_path / f"{j}.tif", image, photometric="rgb")
    data = bytearray((tmp_path / "2.tif").read_bytes())
    start = len(data) // 3
    stop = 2 * len(data) // 3
    data[start:stop] = np.random.default_rng(1).bytes(stop - start)
    (tmp_path / "2.tif").write_bytes(data)
    warnings = []
    bracket = read_bracket(tmp_path, list(TIMES), note=lambda text: None, warn=warnings.append)
    assert bracket.names == ("0.tif", "1.tif", "3.tif")
    assert "2.tif" in warnings[0]
