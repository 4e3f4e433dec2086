"""Stuck pixels: a pixel that does not follow the exposure gets the median of its neighbors."""

import numpy as np
import pytest

from hdrlab.radiance.stuck import find_stuck, neighbours_median, repair_stuck


def pair(shape=(7, 9), dtype=np.uint8):
    """Return a short and a long frame (H, W, 1) of a dim even scene."""
    unit = (np.iinfo(dtype).max + 1) // 256
    return np.full((*shape, 1), 20 * unit, dtype), np.full((*shape, 1), 120 * unit, dtype)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("where", [(3, 4), (0, 0), (6, 8), (0, 5), (4, 0)])
@pytest.mark.parametrize("level", [255, 200, 0])
def test_a_constant_pixel_that_differs_from_its_neighbors_is_stuck(dtype, where, level):
    short, long = pair(dtype=dtype)
    short[where] = level * (np.iinfo(dtype).max // 255)
    long[where] = level * (np.iinfo(dtype).max // 255)
    expected = np.zeros((7, 9), bool)
    expected[where] = True
    assert np.array_equal(find_stuck(short, long), expected)


def test_one_stuck_channel_makes_a_stuck_pixel():
    short, long = pair()
    short = np.repeat(short, 3, axis=-1)
    long = np.repeat(long, 3, axis=-1)
    short[2, 2, 1] = 255
    long[2, 2, 1] = 255
    assert np.argwhere(find_stuck(short, long)).tolist() == [[2, 2]]


@pytest.mark.parametrize(
    ("short_level", "long_level"),
    [(100, 255), (90, 120), (20, 28), (60, 60)],
    ids=[
        "a bright pixel that follows",
        "one that follows a little",
        "a dim one",
        "one that stands out too little",
    ],
)
def test_a_pixel_that_follows_the_exposure_or_does_not_stand_out_is_not_stuck(
    short_level, long_level
):
    short, long = pair()
    short[3, 4] = short_level
    long[3, 4] = long_level
    assert not find_stuck(short, long).any()


def test_two_adjacent_pixels_are_not_stuck():
    short, long = pair()
    short[3, 4:6] = 255
    long[3, 4:6] = 255
    assert not find_stuck(short, long).any()


@pytest.mark.parametrize("shape", [(1, 1), (1, 5), (5, 1)])
def test_no_pixel_of_a_tiny_image_is_stuck(shape):
    short, long = pair(shape)
    assert not find_stuck(short, long).any()


def test_the_median_is_that_of_the_eight_neighbours():
    E = np.arange(25, dtype=np.float32).reshape(5, 5)
    E[2, 2] = 1000
    mask = E == 1000
    assert neighbours_median(E, mask).tolist() == [12.0]  # of 6 7 8 11 13 16 17 18
    colour = np.stack([E, 2 * E], axis=-1)
    assert neighbours_median(colour, mask).tolist() == [[12.0, 24.0]]


def test_at_the_border_the_picture_is_continued_by_reflection():
    E = np.array([[100, 1, 5], [2, 3, 6], [7, 8, 9]], np.float32)
    mask = E == 100
    assert neighbours_median(E, mask).tolist() == [np.median([1, 1, 2, 2, 3, 3, 3, 3])]


@pytest.mark.parametrize(("ratio", "mended"), [(2.0, True), (1.9, False)])
def test_hot_pixels_are_found_if_the_exposures_differ_by_at_least_one_stop(ratio, mended):
    frames = np.full((2, 9, 9, 1), 60, np.uint8)
    frames[1] = 120
    frames[:, 4, 4] = 250
    E = np.ones((9, 9, 1), np.float32)
    E[4, 4] = 50
    assert repair_stuck(E, frames, np.array([1.0, ratio]), None).any() == mended
    assert E[4, 4] == (1 if mended else 50)
