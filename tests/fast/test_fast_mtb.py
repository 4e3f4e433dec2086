"""What `fast.mtb` promises beside its lesson's answers: words that count as pixels do."""

import numpy as np
import pytest
from brackets import bracket
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import zoom
from skimage.data import camera

from hdrlab.align import mtb as lesson
from hdrlab.fast import mtb


@given(st.integers(1, 12), st.integers(1, 140), st.integers(0, 2**32 - 1), st.data())
@settings(max_examples=30, deadline=None)
def test_counting_in_words_is_counting_pixel_by_pixel(rows, columns, seed, data):
    rng = np.random.default_rng(seed)
    fixed, moving = rng.random((2, 2, rows, columns)) < 0.6
    y, x = data.draw(st.tuples(st.integers(-15, 15), st.integers(-150, 150)))
    found = mtb._errors(mtb._pack(fixed), mtb._pack(moving), (y, x))
    for (dy, dx), error in lesson.step(fixed, moving, (y, x)).items():
        assert found[dy - y + 1, dx - x + 1] == error


@given(st.integers(1, 5), st.integers(1, 200), st.integers(-210, 210), st.integers(0, 2**32 - 1))
@settings(deadline=None)
def test_what_slides_out_on_one_side_does_not_come_in_on_the_other(rows, columns, dx, seed):
    mask = np.random.default_rng(seed).random((rows, columns)) < 0.5
    wide = np.pad(mask, ((0, 0), (300, 300)))
    expected = np.roll(wide, dx, axis=1)
    expected[:, : max(dx, 0)] = False
    assert np.array_equal(mtb._slide(mtb._pack(wide), dx), mtb._pack(expected))


def test_the_threshold_of_a_large_picture_is_the_median_to_one_code():
    Y = zoom(camera(), 4, order=1)
    assert abs(mtb.Photograph(Y).threshold(0.5) - np.median(Y)) <= 1


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("knobs", [{}, {"luma": True}, {"bits": 3}])
def test_a_bracket_of_ordinary_size_is_aligned_as_the_lesson_does(dtype, knobs):
    images = bracket([(0, 0), (13, -22), (-7, 5)], [1, 4, 16], dtype=dtype)
    assert np.array_equal(mtb.align(images, **knobs), lesson.align(images, **knobs))


@pytest.mark.parametrize(
    "images, bits",
    [
        (np.zeros((2, 8, 8)), 6),
        (np.zeros((8, 8), np.uint8), 6),
        (np.zeros((2, 8, 8, 4), np.uint8), 6),
        ([np.zeros((8, 8), np.uint8), np.zeros((8, 9), np.uint8)], 6),
        ([np.zeros((8, 8), np.uint8), np.zeros((8, 8), np.uint16)], 6),
        (np.zeros((2, 8, 8), np.uint8), 0),
    ],
)
def test_what_is_not_a_stack_of_photographs_is_refused(images, bits):
    with pytest.raises(ValueError, match="expected"):
        mtb.align(images, bits=bits)
