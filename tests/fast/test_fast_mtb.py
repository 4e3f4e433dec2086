"""`fast.mtb` counts bits in words as the lesson counts pixels."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from scipy.ndimage import zoom
from skimage.data import camera
from support.hand_held_photos import bracket

from hdrlab.align import mtb as lesson
from hdrlab.errors import InputError
from hdrlab.fast import mtb


@given(st.integers(1, 12), st.integers(1, 140), st.integers(0, 2**32 - 1), st.data())
@settings(max_examples=30, deadline=None)
def test_errors_counted_in_machine_words_equal_errors_counted_per_pixel(rows, columns, seed, data):
    fixed, moving = np.random.default_rng(seed).integers(0, 256, (2, rows, columns), dtype=np.uint8)
    offset = data.draw(st.tuples(st.integers(-15, 15), st.integers(-150, 150)))
    both = mtb.Photograph(moving), mtb.Photograph(fixed)
    differ, compared = both[0].count_differences(both[1], offset, 0).sum(axis=0)
    assert differ / max(compared, 1) == lesson.error(
        lesson.bitmaps(fixed), lesson.bitmaps(moving), offset
    )


@pytest.mark.parametrize("offset", [(0, 0), (7, -4), (-90, 33)])
def test_comparing_some_rows_of_a_large_image_gives_nearly_the_same_error(offset):
    Y = zoom(camera(), 2.5, order=1)
    dy, dx = offset
    shape = (1000, 1100)
    fixed = Y[100:1100, 100:1200]
    moving = Y[100 + dy : 1100 + dy, 100 + dx : 1200 + dx] // 2
    assert mtb.align(np.stack([moving, fixed]), bits=8)[0].tolist() == [dy, dx]
    both = mtb.Photograph(moving), mtb.Photograph(fixed)
    some = both[0].count_differences(both[1], (dy + 2, dx), 0).sum(axis=0)
    all_ = lesson.error(lesson.bitmaps(fixed), lesson.bitmaps(moving), (dy + 2, dx))
    assert some[1] < shape[0] * shape[1] / 2 and some[0] / some[1] == pytest.approx(all_, rel=0.3)


def test_the_threshold_of_a_large_image_is_within_one_code_of_the_median():
    Y = zoom(camera(), 4, order=1)
    assert abs(mtb.Photograph(Y).threshold(0.5) - np.median(Y)) <= 1


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("knobs", [{}, {"luma": True}, {"bits": 3}])
def test_a_bracket_is_aligned_like_by_the_lesson(dtype, knobs):
    images = bracket([(0, 0), (13, -22), (-7, 5)], [1, 4, 16], dtype=dtype)
    assert np.array_equal(mtb.align(images, **knobs), lesson.align(images, **knobs))


@pytest.mark.parametrize(
    ("images", "bits"),
    [
        (np.zeros((2, 8, 8)), 6),
        (np.zeros((8, 8), np.uint8), 6),
        (np.zeros((2, 8, 8, 4), np.uint8), 6),
        ([np.zeros((8, 8), np.uint8), np.zeros((8, 9), np.uint8)], 6),
        ([np.zeros((8, 8), np.uint8), np.zeros((8, 8), np.uint16)], 6),
        (np.zeros((2, 8, 8), np.uint8), 0),
    ],
)
def test_invalid_stacks_raise_an_error(images, bits):
    with pytest.raises(InputError):
        mtb.align(images, bits=bits)


def test_one_bit_finds_a_shift_of_one_pixel():
    Y = camera()
    frames = np.stack([Y, np.roll(Y, 1, axis=1)])
    assert np.abs(mtb.align(frames, bits=1)).max() == 1
    with pytest.raises(ValueError, match="at least 1 bit"):
        mtb.align(frames, bits=0)


@pytest.mark.parametrize("shape", [(38, 20), (107, 33)])
def test_pyramid_levels_equal_those_of_the_lesson(shape):
    Y = np.random.default_rng(1).integers(0, 256, shape, dtype=np.uint8)
    assert np.array_equal(mtb.Photograph(Y, bits=2).Y[1], lesson.shrink(Y))
