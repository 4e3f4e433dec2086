"""Samples for a calibration: the same points of the scene in every photo."""

import numpy as np
import pytest
from hypothesis import example, given, strategies as st

from hdrlab.core.arrays import to_256
from hdrlab.core.sampling import by_grid, by_rank

WAYS = [by_rank, by_grid]


def frames(shape=(30, 40), dtype=np.uint8):
    """Return three frames of one scene, each a rising function of the same light."""
    light = np.random.default_rng(1).random(shape)
    top = np.iinfo(dtype).max
    return (
        np.stack([np.clip(light * gain, 0, 1) * top for gain in (0.3, 1, 1.5)])
        .round()
        .astype(dtype)
    )


@pytest.mark.parametrize("channels", [(), (3,)])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("way", WAYS)
def test_samples_are_levels_of_256_per_sample_frame_and_channel(way, dtype, channels):
    Z = way(frames((30, 40, *channels), dtype), 100)
    assert Z.dtype == np.intp and Z.shape[1:] == (3, *channels)
    assert 80 <= len(Z) <= 100 and Z.min() >= 0 and Z.max() <= 255


@pytest.mark.parametrize("way", WAYS)
def test_16_bit_photos_are_sampled_like_8_bit_ones(way):
    images = frames()
    assert np.array_equal(way(images, 50), way(images.astype(np.uint16) * 257, 50))


def test_to_256_rounds_to_the_nearest_level():
    assert to_256(np.array([0, 128, 129, 257, 65535], np.uint16)).tolist() == [0, 0, 1, 1, 255]
    images = frames()
    assert to_256(images) is images


def test_ranks_are_the_quantiles_of_each_frame():
    images = np.arange(256, dtype=np.uint8).reshape(1, 16, 16)
    assert by_rank(images, 4)[:, 0].tolist() == [32, 96, 160, 224]
    assert by_rank(images, 256)[:, 0].tolist() == list(range(256))


@given(st.integers(1, 400))
def test_ranks_rise_with_the_light_in_every_frame(count):
    Z = by_rank(frames(), count)
    assert Z.shape == (count, 3) and np.all(np.diff(Z, axis=0) >= 0)


def test_samples_by_rank_do_not_depend_on_pixel_positions():
    images = frames()
    moved = np.stack([np.roll(image, (j, -2 * j), axis=(0, 1)) for j, image in enumerate(images)])
    assert np.array_equal(by_rank(images, 60), by_rank(moved, 60))


@given(st.integers(1, 3000), st.integers(1, 40), st.integers(1, 40))
@example(1, 4, 1)
def test_a_grid_sample_has_at_most_the_requested_number_of_pixels(count, height, width):
    images = np.arange(height * width, dtype=np.uint16).reshape(1, height, width) % 256
    images = np.concatenate([images, images // 2]).astype(np.uint8)
    Z = by_grid(images, count)
    assert 1 <= len(Z) <= max(count, 1) and np.array_equal(Z[:, 1], Z[:, 0] // 2)


def test_a_grid_as_large_as_the_picture_is_the_picture():
    images = frames((6, 6))
    assert np.array_equal(by_grid(images, 36), images.reshape(3, 36).T)


@pytest.mark.parametrize("way", WAYS)
def test_masked_pixels_are_not_sampled(way):
    images = np.clip(frames(), 0, 200)
    valid = np.ones(images.shape, bool)
    images[1, 5:20] = 255
    valid[1, 5:20] = False
    assert 255 not in way(images, 200, valid=valid) and 255 in way(images, 200)


@pytest.mark.parametrize("way", WAYS)
def test_a_mask_that_leaves_nothing_raises_an_error(way):
    valid = np.ones((3, 30, 40), bool)
    valid[0, :15] = False
    valid[2, 15:] = False
    with pytest.raises(ValueError, match="masks leave none"):
        way(frames(), 10, valid=valid)


@pytest.mark.parametrize("way", WAYS)
def test_a_mask_of_another_shape_raises_an_error(way):
    with pytest.raises(ValueError, match=r"mask of shape \(3, 30, 40\)"):
        way(frames(), 10, valid=np.ones((30, 40), bool))
