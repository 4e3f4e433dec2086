"""Every operator on unusual maps: black, a single lamp, huge or tiny values, other types."""

import numpy as np
import pytest

from hdrlab import pipeline
from hdrlab.errors import InputError
from hdrlab.pipeline import catalogue
from hdrlab.tonemap import durand, local_laplacian, reinhard

OPERATORS = ["photograph", *catalogue.names("tonemap")]
E = np.random.default_rng(0).uniform(0.1, 5, (40, 56, 3)).astype(np.float32)
# the largest difference of 8-bit values: rounding moves a percentile to the next pixel at most
ROUNDING = 1


class ArrayLike:
    """An object that has only the method by which NumPy reads it."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return self.array if dtype is None else self.array.astype(dtype)


def is_same_picture(first, second):
    return np.abs(first.astype(int) - second).max() <= ROUNDING


@pytest.mark.parametrize("shape", [(40, 56, 3), (40, 56), (1, 1, 3)])
@pytest.mark.parametrize("operator", OPERATORS)
def test_map_without_light_is_a_black_picture(operator, shape):
    assert not pipeline.develop(np.zeros(shape), operator).any()


@pytest.mark.parametrize("operator", OPERATORS)
def test_pixels_around_a_lamp_in_the_dark_are_black(operator):
    lamp = np.zeros_like(E)
    lamp[20:23, 20:23] = 1
    picture = pipeline.develop(lamp, operator)
    assert picture[21, 21].min() > 100
    assert np.count_nonzero(picture.max(axis=-1)) == 9


@pytest.mark.parametrize("scale", [6e37, 1e-30, 1e-38])
@pytest.mark.parametrize("operator", OPERATORS)
def test_picture_does_not_depend_on_the_unit_of_light_at_the_ends_of_float32(operator, scale):
    usual = pipeline.develop(E, operator)
    assert is_same_picture(pipeline.develop(E * np.float32(scale), operator), usual)


@pytest.mark.parametrize("operator", OPERATORS)
def test_map_of_one_value_is_an_even_picture(operator):
    usual = pipeline.develop(np.full_like(E, 0.7), operator)
    assert np.ptp(usual) == 0
    assert is_same_picture(pipeline.develop(np.full_like(E, 3e38), operator), usual)


@pytest.mark.parametrize(
    "convert",
    [
        lambda E: E.astype(np.float64),
        lambda E: E.astype(">f4"),
        lambda E: np.asfortranarray(E),
        lambda E: np.repeat(E, 2, axis=0)[::2],
        ArrayLike,
    ],
    ids=["float64", "big-endian", "Fortran order", "strided", "only __array__"],
)
@pytest.mark.parametrize("operator", OPERATORS)
def test_picture_does_not_depend_on_how_the_map_is_stored(operator, convert):
    usual = pipeline.develop(E, operator)
    assert is_same_picture(pipeline.develop(convert(E), operator), usual)


@pytest.mark.parametrize("operator", OPERATORS)
def test_half_floats_are_read_as_the_numbers_that_they_are(operator):
    half = E.astype(np.float16)
    usual = pipeline.develop(half.astype(np.float32), operator)
    assert np.array_equal(pipeline.develop(half, operator), usual)


@pytest.mark.parametrize(
    "wrong",
    [
        np.where(E > 2, np.nan, E),
        np.where(E > 2, -1, E),
        np.where(E > 2, np.inf, E),
        np.ma.masked_greater(E, 2),
        np.zeros((0, 4, 3)),
    ],
    ids=["NaN", "negative", "infinite", "masked", "empty"],
)
@pytest.mark.parametrize("operator", OPERATORS)
def test_map_that_is_no_light_is_refused(operator, wrong):
    with pytest.raises(InputError):
        pipeline.develop(wrong, operator)


@pytest.mark.parametrize("chapter", [durand, local_laplacian, reinhard])
def test_luminance_without_light_stays_black_in_the_lessons(chapter):
    assert not chapter.tonemap(np.zeros((12, 16))).any()
