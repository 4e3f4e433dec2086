"""One damaged photo never stops the others, and hdrlab always names it."""

import numpy as np
import pytest

from hdrlab import pipeline
from hdrlab.capture import camera
from hdrlab.errors import FileFormatError
from hdrlab.io import photos
from hdrlab.scenes import room

TIMES = [0.01, 0.04, 0.16, 0.64]


def cut(data):
    return data[: len(data) // 2] + b"\xff\xd9"


def zero_the_header(data):
    return bytes(512) + data[512:]


@pytest.fixture
def folder(tmp_path):
    shots = camera.shoot(room((64, 96)), TIMES, rng=1)
    for number, image in enumerate(shots.images, 1):
        photos.write_picture(tmp_path / f"{number}.jpg", image)
    return tmp_path


def damage(path, how):
    path.write_bytes(how(path.read_bytes()))


def read(paths, times):
    messages = []
    bracket = photos.read_bracket(paths, times, note=messages.append, warn=messages.append)
    return bracket, messages


@pytest.mark.parametrize("how", [cut, zero_the_header])
@pytest.mark.parametrize("number", [1, 3, 4])
@pytest.mark.parametrize("as_folder", [True, False])
def test_damaged_photo_is_left_out_and_named(folder, how, number, as_folder):
    paths = sorted(folder.glob("*.jpg"))
    sound, _ = read(paths, TIMES)
    damage(folder / f"{number}.jpg", how)
    bracket, messages = read(folder if as_folder else paths, TIMES)
    kept = [j for j in range(4) if j != number - 1]
    assert bracket.names == tuple(sound.names[j] for j in kept)
    np.testing.assert_array_equal(bracket.images, sound.images[kept])
    np.testing.assert_array_equal(bracket.times, sound.times[kept])
    assert [f"{number}.jpg" in sentence for sentence in messages] == [True]
    assert f"{number}.jpg" in " ".join(bracket.damaged)


@pytest.mark.parametrize("how", [cut, zero_the_header])
def test_the_map_of_a_bracket_with_a_damaged_photo_has_a_warning_that_names_it(folder, how):
    damage(folder / "2.jpg", how)
    bracket, _ = read(folder, {f"{j}.jpg": TIMES[j - 1] for j in (1, 2, 3, 4)})
    assembly = pipeline.assemble(bracket)
    assert any("2.jpg" in warning for warning in assembly.warnings)


@pytest.mark.parametrize("how", [cut, zero_the_header])
def test_one_sound_photo_is_not_enough(folder, how):
    for number in (1, 2, 4):
        damage(folder / f"{number}.jpg", how)
    with pytest.raises(FileFormatError, match=r"1\.jpg"):
        photos.read_bracket(folder, TIMES)


def test_the_mask_of_a_bracket_goes_with_its_sound_photos(folder):
    damage(folder / "3.jpg", cut)
    with pytest.warns(UserWarning, match=r"3\.jpg"):
        bracket = photos.read_bracket(folder, TIMES, mask=(0, 0, 255))
    assert bracket.valid.shape == bracket.images.shape[:3]
