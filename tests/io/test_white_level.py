"""The white level of 16-bit photos that hold 12 or 14 bits."""

from pathlib import Path

import numpy as np
import pytest
import tifffile

from hdrlab.io.photos import read_bracket
from hdrlab.pipeline import assemble

TIMES = [1 / 64, 1 / 16, 1 / 4, 1.0]
CASES = Path(__file__).parents[3] / "shared/data/cases"
SHAPE = (60, 80, 3)


def make_scene():
    """Return linear light from 0.02 to 20, in patches and with a slope."""
    rng = np.random.default_rng(3)
    patches = np.exp(rng.uniform(np.log(0.02), np.log(20), (6, 8, 3)))
    return patches.repeat(10, axis=0).repeat(10, axis=1) * np.linspace(1, 1.3, SHAPE[1])[:, None]


def write_bracket(folder, *, white, times=TIMES, scene=None):
    """Write photos of linear light that is clipped at a pixel value, and return them."""
    scene = make_scene() if scene is None else scene
    photos = []
    for j, time in enumerate(times):
        photo = np.uint16(np.rint(np.minimum(scene * time, 1) * white))
        tifffile.imwrite(folder / f"{j}.tif", photo, photometric="rgb")
        photos.append(photo)
    return photos


@pytest.mark.parametrize("white", [1023, 4095, 16383, 15871])
def test_clipped_pixels_of_fewer_bits_become_white(tmp_path, white):
    photos = write_bracket(tmp_path, white=white)
    notes = []
    bracket = read_bracket(tmp_path, TIMES, note=notes.append)
    assert any(str(white) in text for text in notes)
    for image, photo in zip(bracket.images, photos, strict=True):
        np.testing.assert_allclose(image, photo * (65535 / white), atol=0.51)


def test_map_of_12_bits_is_that_of_16_bits(tmp_path):
    maps = []
    for white in (4095, 65535):
        folder = tmp_path / str(white)
        folder.mkdir()
        write_bracket(folder, white=white)
        assembly = assemble(read_bracket(folder, TIMES, note=lambda text: None))
        np.testing.assert_allclose(assembly.bracket.times, TIMES)
        maps.append(assembly.E)
    stops = np.abs(np.log2(maps[0] / maps[1]))
    assert np.median(stops) < 0.01
    assert np.quantile(stops, 0.95) < 0.05


def test_photos_with_16_bits_stay(tmp_path):
    photos = write_bracket(tmp_path, white=65535)
    bracket = read_bracket(tmp_path, TIMES, note=lambda text: None)
    np.testing.assert_array_equal(bracket.images, photos)


def test_dark_photos_without_clipped_pixels_stay(tmp_path):
    photos = write_bracket(tmp_path, white=65535, times=[1 / 256, 1 / 64, 1 / 32])
    assert max(photo.max() for photo in photos) < 65535
    notes = []
    bracket = read_bracket(tmp_path, [1 / 256, 1 / 64, 1 / 32], note=notes.append)
    np.testing.assert_array_equal(bracket.images, photos)
    assert not any("white" in text for text in notes)


def test_flat_white_card_is_no_white_level(tmp_path):
    """The brightest surface has one value in each photo, but another one in the next photo."""
    scene = np.minimum(make_scene(), 5.0)
    photos = write_bracket(tmp_path, white=65535, times=[1 / 64, 1 / 32, 1 / 16], scene=scene)
    bracket = read_bracket(tmp_path, [1 / 64, 1 / 32, 1 / 16], note=lambda text: None)
    np.testing.assert_array_equal(bracket.images, photos)


def test_equal_photos_of_a_flat_card_show_no_white_level(tmp_path):
    scene = np.minimum(make_scene(), 5.0)
    photos = write_bracket(tmp_path, white=65535, times=[1 / 64, 1 / 64], scene=scene)
    bracket = read_bracket(tmp_path, [1 / 64, 1 / 64], note=lambda text: None)
    np.testing.assert_array_equal(bracket.images, photos)


def test_masked_border_is_no_white_level(tmp_path):
    scene = make_scene()
    photos = write_bracket(tmp_path, white=40000, times=[1 / 256, 1 / 64], scene=scene)
    for j, photo in enumerate(photos):
        photo[:10] = 50000
        tifffile.imwrite(tmp_path / f"{j}.tif", photo, photometric="rgb")
    color = (50000, 50000, 50000)
    times = [1 / 256, 1 / 64]
    bracket = read_bracket(tmp_path, times, mask=color, note=lambda text: None)
    np.testing.assert_array_equal(bracket.images, photos)


@pytest.mark.parametrize("bits", [12, 14])
def test_case_of_fewer_bits_keeps_its_times(bits):
    folder = CASES / f"tiff_{bits}bit_in_16"
    if not folder.is_dir():
        pytest.skip("no shared data")
    notes = []
    bracket = read_bracket(folder, folder / "times.txt", note=notes.append)
    assembly = assemble(bracket)
    assert any(str(2**bits - 1) in text for text in notes)
    assert not assembly.warnings
    np.testing.assert_allclose(assembly.bracket.times, [4.0**-k for k in (4, 3, 2, 1, 0)])
