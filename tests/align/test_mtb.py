"""`align.mtb`: the equations of Ward's paper, and offsets to the pixel."""

import cv2
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from support.hand_held_photos import bracket

from hdrlab.align import mtb
from hdrlab.align.shift import shift
from hdrlab.errors import InputError


def plain(fixed, moving, offset):
    """Count pixel by pixel the bits that differ and the bits compared; a photo is (bitmap, exclusion)."""
    rows, columns = fixed[0].shape
    differ = 0
    compared = 0
    for y in range(rows):
        for x in range(columns):
            v = y - offset[0]
            u = x - offset[1]
            if 0 <= v < rows and 0 <= u < columns and fixed[1][y, x] and moving[1][v, u]:
                compared += 1
                differ += fixed[0][y, x] != moving[0][v, u]
    return differ, compared


# the slide's equations


def test_gray_is_green_or_the_slides_weighted_sum():
    image = np.random.default_rng(0).integers(0, 256, (70, 9, 3), dtype=np.uint8)
    R, G, B = np.moveaxis(image.astype(int), -1, 0)
    assert np.array_equal(mtb.gray(image), image[..., 1])
    assert np.array_equal(mtb.gray(image, luma=True), (54 * R + 183 * G + 19 * B) // 256)
    assert np.array_equal(mtb.gray(image[..., 0]), image[..., 0])


def test_luma_of_white_is_255_and_of_black_0():
    for level in (0, 255):
        assert np.all(mtb.gray(np.full((4, 5, 3), level, np.uint8), luma=True) == level)


def test_sixteen_bits_are_read_as_the_same_256_codes():
    image = np.random.default_rng(0).integers(0, 256, (40, 30, 3), dtype=np.uint8)
    assert np.array_equal(mtb.gray(image.astype(np.uint16) * 257), mtb.gray(image))


@given(st.integers(1, 12), st.integers(1, 40), st.integers(0, 2**32 - 1), st.data())
@settings(max_examples=30, deadline=None)
def test_the_error_counts_pixel_by_pixel_over_the_overlap_alone(rows, columns, seed, data):
    rng = np.random.default_rng(seed)
    fixed, moving = rng.random((2, 2, rows, columns)) < 0.6
    offset = data.draw(st.tuples(st.integers(-15, 15), st.integers(-45, 45)))
    differ, compared = plain(fixed, moving, offset)
    assert mtb.error(fixed, moving, offset) == differ / max(compared, 1)


def test_half_the_pixels_are_above_the_threshold():
    state = list(mtb.align_steps(bracket([(0, 0)] * 2, [1, 2])))[-1]
    assert np.allclose([state.fixed[0].mean(), state.moving[0].mean()], 0.5, atol=0.02)


def test_in_a_tie_the_current_offset_is_kept():
    flat = np.zeros((2, 40, 60), bool)
    flat[1] = True
    errors = mtb.step(flat, flat, (3, -2))
    assert min(errors, key=errors.get) == (3, -2) and len(errors) == 9 and not any(errors.values())


def test_a_step_compares_nine_offsets_with_the_sides_before_the_corners():
    mask = np.random.default_rng(0).random((2, 60, 90)) < 0.5
    mask[1] = True
    errors = mtb.step(mask, np.roll(mask, (-1, 1), axis=(1, 2)), (0, 0))
    assert min(errors, key=errors.get) == (1, -1)
    assert [abs(dy) + abs(dx) for dy, dx in errors] == [0, 1, 1, 1, 1, 2, 2, 2, 2]


# the search, step by step


def test_a_pair_is_searched_from_the_coarsest_level_to_the_finest_each_starting_from_twice_the_last():
    states = list(mtb.align_steps(bracket([(0, 0), (21, -34)], [1, 4])))
    assert [state.level for state in states] == [5, 4, 3, 2, 1, 0][-len(states) :]
    start = (0, 0)
    for state in states:
        assert next(iter(state.errors)) == start
        assert state.errors[state.offset] == min(state.errors.values())
        start = tuple(2 * n for n in state.offset)
    assert states[-1].offset == (-21, 34)


def test_a_state_holds_the_bitmaps_of_its_level_with_thresholds_of_that_level():
    images = bracket([(0, 0), (5, 6)], [1, 4])
    for state in mtb.align_steps(images):
        for image, bits in zip(images[::-1], (state.fixed, state.moving), strict=True):
            Y = mtb.gray(image)
            for _ in range(state.level):
                Y = mtb.shrink(Y)
            t = int(mtb.threshold(np.bincount(Y.ravel(), minlength=256), 0.5))
            assert np.array_equal(bits[0], Y.astype(int) - t > 0)
            assert np.array_equal(bits[1], np.abs(Y.astype(int) - t) > 4)


def test_changing_a_yielded_state_does_not_change_the_search():
    images = bracket([(0, 0), (9, -12), (3, 3)], [1, 4, 16])
    offsets = [state.offset for state in mtb.align_steps(images)]
    for state, offset in zip(mtb.align_steps(images), offsets, strict=True):
        assert state.offset == offset
        state.errors.clear(), state.fixed.fill(False), state.moving.fill(False)


# known offsets


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("channels", ["gray", "green", "luma"])
@pytest.mark.parametrize("times", [(1, 4), (4, 1), (0.25, 1)])
def test_known_offsets_are_found_in_photos_two_stops_apart(channels, dtype, times):
    images = bracket([(0, 0), (13, -22)], times, dtype=dtype)
    images = images[..., 0] if channels == "gray" else images
    offsets = mtb.align(images, luma=channels == "luma")
    assert (offsets[1] - offsets[0]).tolist() == [13, -22]


@pytest.mark.parametrize(
    "offset", [(63, 63), (-63, 63), (63, -63), (-63, -63), (63, 0), (0, -63), (31, 32)]
)
def test_the_range_is_two_to_the_bits_minus_one(offset):
    offsets = mtb.align(bracket([offset, (0, 0)], [1, 4]))
    assert (offsets[0] - offsets[1]).tolist() == list(offset)


@pytest.mark.parametrize(("bits", "offset"), [(1, (1, -1)), (3, (7, 7)), (4, (-15, 11))])
def test_fewer_bits_search_a_smaller_range(bits, offset):
    images = bracket([offset, (0, 0)], [1, 4])
    assert mtb.align(images, bits=bits).tolist() == [list(offset), [0, 0]]
    assert all(
        max(map(abs, state.offset)) < 2**bits for state in mtb.align_steps(images, bits=bits)
    )


@pytest.mark.parametrize("noise", [0.01, 0.03])
def test_noise_does_not_move_the_answer_by_more_than_a_pixel(noise):
    offsets = mtb.align(bracket([(0, 0), (-11, 7)], [1, 4], noise=noise))
    assert np.abs(offsets - [[11, -7], [0, 0]]).max() <= 1


def test_opencv_finds_the_same_offset_where_the_median_is_not_clipped():
    images = bracket([(0, 0), (8, -19)], [1, 2])
    dx, dy = cv2.createAlignMTB().calculateShift(images[0, ..., 1], images[1, ..., 1])
    assert (dy, dx) == (8, -19)
    assert mtb.align(images).tolist() == [[-8, 19], [0, 0]]


def test_aligned_and_shifted_frames_show_the_same_scene():
    offsets = [(0, 0), (4, -7), (-3, 12)]
    images = bracket(offsets, [1, 1.01, 1.02], noise=0)
    moved = shift(images, mtb.align(images)).astype(int)
    assert np.abs(moved - moved[0]).max() <= 3


# laws


def test_identical_frames_are_not_moved():
    assert not mtb.align(np.repeat(bracket([(0, 0)], [1]), 3, axis=0)).any()


@pytest.mark.parametrize("order", [(2, 0, 3, 1), (3, 2, 1, 0), (1, 3, 0, 2)])
def test_the_order_of_frames_does_not_change_their_offsets(order):
    images = bracket([(0, 0), (4, -7), (-3, 12), (9, 9)], [0.25, 1, 4, 16])
    assert np.array_equal(mtb.align(images[list(order)]), mtb.align(images)[list(order)])


def test_the_frame_of_middle_brightness_is_not_moved():
    images = bracket([(5, 5), (0, 0), (-3, 2)], [16, 1, 4])
    assert mtb.align(images)[2].tolist() == [0, 0]


def test_a_single_frame_is_not_moved():
    images = bracket([(0, 0)], [1])
    assert mtb.align(images).tolist() == [[0, 0]] and list(mtb.align_steps(images)) == []


@pytest.mark.parametrize("shape", [(1, 1), (1, 300), (10, 10), (17, 63), (16, 64)])
def test_small_frames_are_aligned_without_an_error(shape):
    images = np.random.default_rng(0).integers(0, 256, (3, *shape), dtype=np.uint8)
    offsets = mtb.align(images)
    assert offsets.shape == (3, 2) and np.all(np.abs(offsets) <= 2 * np.array(shape))


def test_chain_offsets_sums_the_pairs_from_the_middle_frame():
    steps = [(1, 2), (10, 20), (100, 0), (0, 5)]
    offsets = mtb.chain_offsets([4, 0, 3, 1, 2], steps)
    assert offsets.tolist() == [[10, 20], [-100, 0], [-100, -5], [0, 0], [11, 22]]


@pytest.mark.parametrize("levels", [(60, 120, 240), (0, 0, 0), (255, 255, 255)])
def test_frames_without_texture_are_not_moved(levels):
    assert not mtb.align(np.stack([np.full((64, 80), level, np.uint8) for level in levels])).any()


@pytest.mark.parametrize(
    ("images", "bits"),
    [
        (np.zeros((2, 8, 8)), 6),
        (np.zeros((8, 8), np.uint8), 6),
        (np.zeros((2, 8, 8, 4), np.uint8), 6),
        (np.zeros((2, 8, 8), np.uint8), 0),
    ],
)
def test_invalid_stacks_raise_an_error(images, bits):
    for verb in (mtb.align, lambda *a, **k: list(mtb.align_steps(*a, **k))):
        with pytest.raises(InputError):
            verb(images, bits=bits)


def test_the_search_uses_one_pyramid_level_per_bit():
    Y = np.random.default_rng(0).integers(0, 256, (512, 640), dtype=np.uint8)
    assert [state.level for state in mtb.search(Y, Y)] == [5, 4, 3, 2, 1, 0]
    assert [state.level for state in mtb.search(Y, Y, bits=2)] == [1, 0]


def histogram(codes):
    """Return the counts of the 256 codes."""
    return np.bincount(np.asarray(codes, int), minlength=256)


def test_the_percentile_is_the_median_if_the_median_divides_both_photos():
    dark = histogram(np.arange(20, 120))
    bright = histogram(np.arange(120, 240))
    assert mtb.percentile(dark, bright) == 0.5


def test_the_percentile_differs_from_the_median_if_a_photo_is_clipped_there():
    clipped = histogram([255] * 60 + list(range(40, 200, 4)))  # 60 of 100 pixels are white
    q = mtb.percentile(clipped, histogram(np.arange(20, 120)))
    assert q == pytest.approx(0.4, abs=0.01)
    assert 0 < mtb.threshold(clipped, q) < 255


def test_the_percentile_is_none_if_no_threshold_divides_the_photo():
    assert mtb.percentile(histogram([128] * 50)) is None  # noise decides every bit
    assert mtb.percentile(histogram([0] * 50 + [255] * 50)) is None
