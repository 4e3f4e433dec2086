"""The small copy of a bracket in which hdrlab looks for motion."""

import numpy as np
import pytest

from hdrlab.capture import responses
from hdrlab.diagnostics.overview import make_overview

G = responses.true_g("film")
TOP = 250


def draw_blocks(rng, low=5, high=240):
    """Return a bracket of two photos (12, 18, 3) and the same in four times the size."""
    images = rng.integers(low, high, (2, 12, 18, 3)).astype(np.uint8)
    return images, images.repeat(4, axis=1).repeat(4, axis=2)


def test_photos_that_are_small_enough_are_not_copied():
    images, _ = draw_blocks(np.random.default_rng(1))
    small = make_overview(images, G, top=TOP)
    assert small.images is images and small.scale == 1


def test_blocks_of_one_pixel_value_keep_it():
    images, large = draw_blocks(np.random.default_rng(2))
    small = make_overview(large, G, top=TOP, max_pixels=12 * 18)
    assert np.array_equal(small.images, images) and small.valid.all()
    gray = make_overview(large[..., 0], G, top=TOP, max_pixels=12 * 18)
    assert np.array_equal(gray.images, images[..., 0])


@pytest.mark.parametrize("curve", ["film", "srgb", "linear"])
def test_means_grow_with_the_exposure_time_as_the_light_does(curve):
    g = responses.true_g(curve)
    exposures = np.exp(g)
    light = np.random.default_rng(3).uniform(exposures[40], exposures[240] / 2, (40, 40))
    photos = [
        np.interp(np.log(light * time), g, np.arange(256)).round().astype(np.uint8)
        for time in (1, 2)
    ]
    small = make_overview(np.stack(photos), g, top=256, max_pixels=100)
    ratio = exposures[small.images[1]] / exposures[small.images[0]]
    assert np.allclose(ratio, 2, rtol=0.06)


def test_a_block_that_is_clipped_in_part_is_not_measured():
    images, large = draw_blocks(np.random.default_rng(4))
    large[0, :4, :4] = 255
    large[1, 4, 4, 1] = 255
    small = make_overview(large, G, top=TOP, max_pixels=12 * 18)
    assert small.valid[0].all() and np.all(small.images[0, 0, 0] >= TOP)
    assert np.argwhere(~small.valid[1]).tolist() == [[1, 1]]


def test_a_block_outside_of_a_photo_in_part_is_not_measured():
    _, large = draw_blocks(np.random.default_rng(5))
    shown = np.ones(large.shape[:3], bool)
    shown[0, 8, 12] = False
    small = make_overview(large, G, top=TOP, valid=shown, max_pixels=12 * 18)
    assert np.argwhere(~small.valid).tolist() == [[0, 2, 3]]


@pytest.mark.parametrize("shape", [(100, 151), (257, 90), (31, 400)])
def test_enlarged_values_cover_the_photos(shape):
    images = np.full((2, *shape), 9, np.uint8)
    small = make_overview(images, G, top=TOP, max_pixels=900)
    assert abs(small.images[0].size / 900 - 1) < 0.2
    assert small.enlarge(small.images[0]).shape == shape
    box = (slice(1, 3), slice(0, 4))
    assert small.enlarge(small.images[0], box).shape == images[0][small.enlarge_box(box)].shape
