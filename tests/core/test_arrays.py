"""Validation of arrays: an error states the expected and the given shape, dtype and range."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from PIL import Image

from hdrlab.core import arrays
from hdrlab.errors import InputError


def test_as_stack_returns_a_valid_array_without_a_copy():
    images = np.zeros((2, 3, 4, 3), np.uint16)
    assert arrays.as_stack(images) is images


@pytest.mark.parametrize("shape", [(3, 4), (3, 4, 3)])
def test_a_list_of_photographs_becomes_one_array(shape):
    frames = [np.full(shape, z, np.uint8) for z in (1, 2)]
    stack = arrays.as_stack(frames)
    assert stack.shape == (2, *shape) and stack.dtype == np.uint8
    assert stack[1].min() == stack[1].max() == 2


@pytest.mark.parametrize(
    ("images", "message"),
    [
        ([], r"stack of images .* got shape \(0,\)"),
        (np.zeros((4, 5), np.uint8), r"got shape \(4, 5\)"),
        (np.zeros((2, 4, 5, 4), np.uint8), r"got shape \(2, 4, 5, 4\)"),
        (np.zeros((2, 0, 5), np.uint8), r"got shape \(2, 0, 5\)"),
        (np.zeros((2, 4, 5)), "uint8 or uint16, got .* float64, values 0 to 0"),
        (np.zeros((2, 4, 5), np.int16), "uint8 or uint16, got .* int16"),
        (np.zeros((2, 4, 5), bool), "uint8 or uint16, got .* bool"),
        (
            [np.zeros((4, 5), np.uint8), np.zeros((4, 6), np.uint8)],
            r"one size .* \(4, 5\) .* \(4, 6\)",
        ),
        (
            [np.zeros((4, 5), np.uint8), np.zeros((4, 5, 3), np.uint8)],
            r"one size .* \(4, 5\) .*\(4, 5, 3\)",
        ),
        (
            [np.zeros((4, 5), np.uint8), np.zeros((4, 5), np.uint16)],
            "one size and type, .* uint16, .* uint8",
        ),
    ],
)
def test_invalid_stacks_raise_an_error(images, message):
    with pytest.raises(ValueError, match=message):
        arrays.as_stack(images)


def test_times_become_float64():
    times = arrays.as_times([1, 2], 2)
    assert times.dtype == np.float64 and times.tolist() == [1, 2]


@pytest.mark.parametrize("times", [[1], [1, 2, 3], [[1, 2]], 1, []])
def test_a_wrong_number_of_times_raises_an_error(times):
    with pytest.raises(ValueError, match="2 exposure times, one per image.*shape"):
        arrays.as_times(times, 2)


@pytest.mark.parametrize("bad", [0, -1, np.nan, np.inf])
def test_times_must_be_positive_and_finite(bad):
    with pytest.raises(ValueError, match=r"positive exposure times in seconds.*\[1.0, "):
        arrays.as_times([1, bad], 2)


def test_a_mask_has_the_shape_of_the_images_or_is_none():
    images = np.zeros((2, 3, 4, 3), np.uint8)
    assert arrays.as_mask(None, images) is None
    assert arrays.as_mask(np.ones((2, 3, 4)), images).dtype == bool
    with pytest.raises(ValueError, match=r"mask of shape \(2, 3, 4\).*shape \(3, 4\)"):
        arrays.as_mask(np.ones((3, 4)), images)


@pytest.mark.parametrize(
    ("check", "shape"),
    [(arrays.as_radiance, (4, 5, 3)), (arrays.as_radiance, (4, 5)), (arrays.as_luminance, (4, 5))],
)
def test_radiance_and_luminance_become_float32_without_a_copy_where_they_are(check, shape):
    E = np.ones(shape, np.float32)
    assert np.shares_memory(check(E), E)
    assert check(np.ones(shape, int)).dtype == np.float32


@pytest.mark.parametrize("check", [arrays.as_radiance, arrays.as_luminance])
def test_the_error_counts_nan_infinite_and_negative_values(check):
    E = np.ones((4, 5))
    E[0, :2] = np.nan
    E[1, :3] = np.inf
    E[2, 0] = -1
    with pytest.raises(ValueError, match="2 NaN, 3 infinite and 1 negative"):
        check(E)


def test_minus_zero_is_accepted_as_radiance():
    assert arrays.as_radiance(np.float32([[-0.0, 1.0]])).tolist() == [[0.0, 1.0]]


def test_a_float64_beyond_float32_counts_as_infinite():
    with pytest.raises(ValueError, match="1 infinite"):
        arrays.as_radiance([[1e39, 1]])


@pytest.mark.parametrize("shape", [(), (5,), (4, 5, 4), (2, 4, 5, 3), (0, 5), (4, 0, 3)])
def test_radiance_of_another_shape_raises_an_error(shape):
    with pytest.raises(ValueError, match="radiance"):
        arrays.as_radiance(np.ones(shape))


@pytest.mark.parametrize("shape", [(), (5,), (4, 5, 3), (0, 5)])
def test_luminance_of_another_shape_raises_an_error(shape):
    with pytest.raises(ValueError, match=r"luminance \(H, W\)"):
        arrays.as_luminance(np.ones(shape))


@pytest.mark.parametrize(
    "values", [np.full((4, 5), "x"), np.ones((4, 5), complex), np.ones((4, 5), bool)]
)
def test_radiance_of_a_non_numeric_type_raises_an_error(values):
    with pytest.raises(ValueError, match="radiance as numbers"):
        arrays.as_radiance(values)


def test_levels_are_those_of_the_type():
    assert arrays.levels(np.zeros(1, np.uint8)) == 256
    assert arrays.levels(np.zeros(1, np.uint16)) == 65536


@given(st.integers(0, 255))
def test_a_table_of_256_levels_keeps_its_values_at_65536_levels(z):
    table = np.sin(np.arange(256))
    read = arrays.as_table(np.stack([table, 2 * table], axis=-1), 65536)
    assert read.shape == (65536, 2) and np.allclose(read[257 * z], [table[z], 2 * table[z]])


def test_a_table_is_interpolated_linearly_between_its_levels():
    assert np.allclose(arrays.as_table([0, 1], 5), [0, 0.25, 0.5, 0.75, 1])


@pytest.mark.parametrize("table", [[1], 3, [1, np.nan], [1, np.inf], np.ones((2, 2, 2))])
def test_invalid_tables_raise_an_error(table):
    with pytest.raises(ValueError, match="finite table over pixel levels"):
        arrays.as_table(table, 256)


def test_a_description_holds_shape_type_and_range():
    description = arrays.describe([[1, 5]])
    assert all(part in description for part in ("(1, 2)", "int64", "1 to 5"))
    assert "(0,)" in arrays.describe([]) and "float64" in arrays.describe([])
    assert "(1,)" in arrays.describe(["a"])


def test_equal_times_raise_an_error_if_they_must_differ():
    assert arrays.as_times([1, 1], 2).tolist() == [1, 1]
    assert arrays.as_times([1, 1, 2], 3, distinct=2).tolist() == [1, 1, 2]
    with pytest.raises(ValueError, match=r"at least 2 different exposure times.*\[1.0, 1.0\] s"):
        arrays.as_times([1, 1], 2, distinct=2)


RISING = np.log(np.arange(1, 257.0))


def test_one_response_is_expanded_to_all_channels_and_65536_levels():
    assert arrays.as_response(RISING, 256, 3).shape == (256, 3)
    table = arrays.as_response(RISING, 65536, 1)
    assert np.array_equal(table[::257, 0], RISING)


@pytest.mark.parametrize(
    ("g", "channels"),
    [
        (RISING[::-1], 1),
        (RISING * 0, 1),
        (RISING * 100, 1),
        (RISING[:200], 1),
        (np.stack([RISING] * 3, axis=-1), 1),
        (np.stack([RISING] * 2, axis=-1), 3),
    ],
    ids=["falls", "flat", "beyond float32", "200 levels", "3 for gray", "2 for colour"],
)
def test_invalid_responses_raise_an_error(g, channels):
    with pytest.raises(InputError):
        arrays.as_response(g, 256, channels)


def test_a_palette_image_raises_an_error():
    with pytest.raises(ValueError, match="palette"):
        arrays.as_stack([Image.new("P", (4, 3))])
    with pytest.raises(ValueError, match="palette"):
        arrays.as_picture(Image.new("P", (4, 3)))
