"""Large photos are reduced before they are read."""

import numpy as np
import pytest
from PIL import Image

from hdrlab.errors import FileFormatError
from hdrlab.io.decode import decode_photo, read_header
from hdrlab.io.reduce import reduce_photo, reduced_size


def read(header):
    """Return the pixels of a photo."""
    pixels = np.empty(header.shape, header.dtype)
    decode_photo(header, pixels)
    return pixels


@pytest.mark.parametrize("suffix", [".jpg", ".png"])
def test_a_reduced_photo_shows_the_same_at_a_smaller_size(tmp_path, suffix):
    y, x = np.mgrid[:480, :640]
    image = np.stack([x / 640, y / 480, 0.5 + 0 * x], axis=-1)
    path = tmp_path / f"ramp{suffix}"
    Image.fromarray((255 * image).astype(np.uint8)).save(path)
    reduced = reduce_photo(read_header(path), tmp_path / "small", 3000)
    height, width = reduced.shape[:2]
    assert height * width <= 3000 and width / height == pytest.approx(4 / 3, rel=0.05)
    expected_x = (np.arange(width) + 0.5) / width
    expected_y = (np.arange(height) + 0.5) / height
    pixels = read(reduced) / 255
    assert np.allclose(pixels[..., 0], expected_x, atol=0.03)
    assert np.allclose(pixels[..., 1], expected_y[:, None], atol=0.03)


def test_a_photo_within_the_limit_keeps_its_pixels(tmp_path):
    image = np.random.default_rng(1).integers(0, 256, (20, 30), np.uint8)
    path = tmp_path / "gray.png"
    Image.fromarray(image).save(path)
    reduced = reduce_photo(read_header(path), tmp_path / "copy", 600)
    assert np.array_equal(read(reduced), image)
    assert reduced_size(1, 10**6, 100) == (1, 10000)


def test_a_photo_that_is_cut_short_is_named(tmp_path):
    path = tmp_path / "cut.jpg"
    image = np.random.default_rng(1).integers(0, 256, (200, 300, 3), np.uint8)
    Image.fromarray(image).save(path)
    path.write_bytes(path.read_bytes()[:20_000])
    with pytest.raises(FileFormatError, match=r"cut\.jpg"):
        reduce_photo(read_header(path), tmp_path / "small", 3000)
