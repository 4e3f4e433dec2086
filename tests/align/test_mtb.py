"""What `align.mtb` promises: offsets to the pixel where photographs tell them, a warning where not."""

import cv2
import imageio.v3 as iio
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter1d, rotate, zoom
from skimage.data import astronaut, camera, coffee

from hdrlab.align import bitmaps, mtb, pairs, pyramid
from hdrlab.align.shift import shift

MARGIN, H, W = 70, 300, 420


def radiance(texture, decades=2.0):
    """Return a scene (H + 2 MARGIN, W + 2 MARGIN, 3) of median 1: a texture under slanting light."""
    rows, columns = H + 2 * MARGIN, W + 2 * MARGIN
    z = max(rows / texture.shape[0], columns / texture.shape[1]) + 0.01
    grown = zoom(texture.astype(np.float32) / 255, (z, z, 1), order=1)[:rows, :columns]
    light = np.linspace(-0.25, 0.25, rows)[:, None, None] + np.linspace(-0.15, 0.15, columns)[None, :, None]
    E = 10 ** (decades * (grown - 0.5 + light))
    return E / np.median(E)


def photograph(E, time, offset=(0, 0), *, rng, dtype=np.uint8, noise=0.004):
    """Return a photograph that must move by `offset` to lie on one taken without any."""
    dy, dx = offset
    X = 0.2 * time * E[MARGIN + dy : MARGIN + dy + H, MARGIN + dx : MARGIN + dx + W]
    X = X + noise * np.sqrt(X + 0.01) * rng.standard_normal(X.shape)
    top = np.iinfo(dtype).max
    return (np.clip(X, 0, 1) ** (1 / 2.2) * top + 0.5).astype(dtype)


def bracket(offsets, times, *, texture=None, decades=2.0, dtype=np.uint8, seed=0, **knobs):
    """Return photographs (P, H, W, 3) of one scene that `offsets` lay on each other."""
    rng = np.random.default_rng(seed)
    E = radiance(astronaut() if texture is None else texture, decades)
    return np.stack(
        [photograph(E, t, o, rng=rng, dtype=dtype, **knobs) for t, o in zip(times, offsets, strict=True)]
    )


def plain(fixed, moving, offset):
    """Return (bits that differ, bits compared) pixel by pixel; each photograph is (bitmap, exclusion)."""
    rows, columns = fixed[0].shape
    differ = compared = 0
    for y in range(rows):
        for x in range(columns):
            v, u = y - offset[0], x - offset[1]
            if 0 <= v < rows and 0 <= u < columns and fixed[1][y, x] and moving[1][v, u]:
                compared += 1
                differ += fixed[0][y, x] != moving[0][v, u]
    return differ, compared


# the bitmaps


@given(st.integers(1, 12), st.integers(1, 140), st.integers(0, 2**32 - 1), st.data())
@settings(max_examples=30, deadline=None)
def test_counting_in_words_is_counting_pixel_by_pixel(rows, columns, seed, data):
    rng = np.random.default_rng(seed)
    fixed, moving = rng.random((2, 2, rows, columns)) < 0.6
    offset = data.draw(st.tuples(st.integers(-15, 15), st.integers(-150, 150)))
    found = bitmaps.around(bitmaps.pack(fixed), bitmaps.pack(moving), offset, stride=2)
    i, j = data.draw(st.tuples(st.integers(0, 2), st.integers(0, 2)))
    at = offset[0] + 2 * (i - 1), offset[1] + 2 * (j - 1)
    assert tuple(found[i, j]) == plain(fixed, moving, at)


@given(st.integers(1, 5), st.integers(1, 200), st.integers(-210, 210), st.integers(0, 2**32 - 1))
@settings(deadline=None)
def test_what_slides_out_on_one_side_does_not_come_in_on_the_other(rows, columns, dx, seed):
    mask = np.random.default_rng(seed).random((rows, columns)) < 0.5
    slid = bitmaps.slide(bitmaps.pack(np.pad(mask, ((0, 0), (0, 300)))), dx)
    expected = np.zeros((rows, columns + 300), bool)
    for x in range(columns):
        if x + dx >= 0:
            expected[:, x + dx] = mask[:, x]
    assert np.array_equal(bitmaps.unpack(slid, columns + 300), expected)


def test_a_packed_mask_unpacks_to_itself():
    mask = np.random.default_rng(0).random((3, 7, 131)) < 0.5
    assert np.array_equal(bitmaps.unpack(bitmaps.pack(mask), 131), mask)


# the slide's equations


def test_gray_is_green_or_the_slides_weighted_sum():
    image = np.random.default_rng(0).integers(0, 256, (70, 9, 3), dtype=np.uint8)
    R, G, B = np.moveaxis(image.astype(int), -1, 0)
    assert np.array_equal(pyramid.gray(image), image[..., 1])
    assert np.array_equal(pyramid.gray(image, luma=True), (54 * R + 183 * G + 19 * B) // 256)
    assert np.array_equal(pyramid.gray(image[..., 0]), image[..., 0])


def test_white_stays_white_and_black_black_in_gray():
    for level in (0, 255):
        assert np.all(pyramid.gray(np.full((4, 5, 3), level, np.uint8), luma=True) == level)


def test_sixteen_bits_are_read_as_the_same_256_codes():
    image = np.random.default_rng(0).integers(0, 256, (40, 30, 3), dtype=np.uint8)
    assert np.array_equal(pyramid.gray(image.astype(np.uint16) * 257), pyramid.gray(image))


def test_the_threshold_of_a_large_picture_is_the_median_to_one_code():
    Y = zoom(camera(), 4, order=1)
    assert abs(int(mtb.threshold(pyramid.histogram(Y), 0.5)) - np.median(Y)) <= 1


def test_half_the_pixels_are_above_the_threshold():
    (state, *_) = list(mtb.align_steps(bracket([(0, 0)] * 2, [1, 2])))[-1:]
    assert state.q == 0.5
    assert np.allclose(state.bitmaps.mean(axis=(1, 2)), 0.5, atol=0.02)


def test_in_a_tie_the_centre_stays():
    flat = np.zeros((2, 40, 1), np.uint64)
    flat[1] = ~np.uint64(0)
    errors, offset = mtb.step(flat, flat, (3, -2))
    assert offset == (3, -2) and np.all(errors == 0)


def test_a_step_takes_the_best_of_nine():
    mask = np.random.default_rng(0).random((2, 60, 90)) < 0.5
    mask[1] = True
    moving = np.roll(mask, (-1, 1), axis=(1, 2))
    errors, offset = mtb.step(bitmaps.pack(mask), bitmaps.pack(moving), (0, 0))
    assert offset == (1, -1)
    assert np.unravel_index(errors.argmin(), (3, 3)) == (2, 0)


# the search, step by step


def test_a_pair_is_searched_from_the_coarsest_level_to_the_finest_each_starting_from_twice_the_last():
    images = bracket([(0, 0), (21, -34)], [1, 4])
    states = list(mtb.align_steps(images))
    assert [state.level for state in states] == [5, 4, 3, 2, 1, 0][-len(states) :]
    start = np.zeros(2, int)
    for state in states:
        assert np.abs(np.array(state.offset) - start).max() <= 1
        assert state.errors.min() == state.errors[tuple(np.array(state.offset) - start + 1)]
        start = 2 * np.array(state.offset)
    assert states[-1].offset == mtb.verdicts(images)[0].offset == (-21, 34)


def test_a_state_shows_the_bitmaps_of_its_level_with_thresholds_of_that_level():
    images = bracket([(0, 0), (5, 6)], [1, 4])
    for state in mtb.align_steps(images):
        for image, t, bits, kept in zip(
            (images[state.fixed], images[state.moving]),
            state.thresholds,
            state.bitmaps,
            state.exclusions,
            strict=True,
        ):
            Y = pyramid.gray(image)
            for _ in range(state.level):
                Y = pyramid.shrink(Y)
            assert t == mtb.threshold(pyramid.histogram(Y), state.q)
            assert np.array_equal(bits, Y.astype(int) - t > 0)
            assert np.array_equal(kept, np.abs(Y.astype(int) - t) > 4)


def test_what_is_done_to_a_state_does_not_reach_the_search():
    images = bracket([(0, 0), (9, -12), (3, 3)], [1, 4, 16])
    for state in mtb.align_steps(images):
        state.errors[:], state.bits[0][:], state.bits[1][:] = 0, 0, 0
        last = state.offset
    assert last == mtb.verdicts(images)[-1].offset


# known offsets


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("channels", ["gray", "green", "luma"])
@pytest.mark.parametrize("times", [(1, 4), (4, 1), (0.25, 1)])
def test_known_offsets_are_found_two_stops_apart(channels, dtype, times):
    images = bracket([(0, 0), (13, -22)], times, dtype=dtype)
    images = images[..., 0] if channels == "gray" else images
    offsets = mtb.align(images, luma=channels == "luma")
    assert (offsets[1] - offsets[0]).tolist() == [13, -22]


@pytest.mark.parametrize("offset", [(63, 63), (-63, 63), (63, -63), (-63, -63), (63, 0), (0, -63), (31, 32)])
def test_the_range_is_two_to_the_bits_minus_one(offset):
    offsets = mtb.align(bracket([offset, (0, 0)], [1, 4]))
    assert (offsets[0] - offsets[1]).tolist() == list(offset)


@pytest.mark.parametrize("bits, offset", [(1, (1, -1)), (3, (7, 7)), (4, (-15, 11))])
def test_fewer_bits_reach_less_far(bits, offset):
    images = bracket([offset, (0, 0)], [1, 4])
    assert mtb.align(images, bits=bits).tolist() == [list(offset), [0, 0]]
    assert all(max(map(abs, found.offset)) < 2**bits for found in mtb.verdicts(images, bits=bits))


@pytest.mark.parametrize("seed", range(4))
def test_seven_frames_of_twelve_stops_are_aligned_through_their_neighbours(seed):
    rng = np.random.default_rng(seed)
    true = np.cumsum(rng.integers(-9, 10, (7, 2)), axis=0)
    true -= true[3]
    images = bracket(
        true, 4.0 ** np.arange(-3, 4), texture=[astronaut(), coffee()][seed % 2], decades=5.0, seed=seed
    )
    assert np.abs(mtb.align(images) - true).max() <= 1
    assert all(verdict.informative for verdict in mtb.verdicts(images))


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


def test_identical_frames_stay_and_agree_entirely():
    images = np.repeat(bracket([(0, 0)], [1]), 3, axis=0)
    assert not mtb.align(images).any()
    for verdict in mtb.verdicts(images):
        assert (verdict.before, verdict.after, verdict.confidence, verdict.trouble) == (0, 0, 1, "")


@pytest.mark.parametrize("order", [(2, 0, 3, 1), (3, 2, 1, 0), (1, 3, 0, 2)])
def test_frames_in_another_order_get_the_same_offsets_in_that_order(order):
    images = bracket([(0, 0), (4, -7), (-3, 12), (9, 9)], [0.25, 1, 4, 16])
    assert np.array_equal(mtb.align(images[list(order)]), mtb.align(images)[list(order)])


def test_the_middle_frame_in_brightness_stays():
    images = bracket([(5, 5), (0, 0), (-3, 2)], [16, 1, 4])
    assert mtb.align(images)[2].tolist() == [0, 0]


def test_one_frame_has_nothing_to_be_aligned_with():
    images = bracket([(0, 0)], [1])
    assert mtb.align(images).tolist() == [[0, 0]]
    assert mtb.verdicts(images) == () and list(mtb.align_steps(images)) == []


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=20, deadline=None)
def test_an_offset_is_never_worse_than_none_by_its_own_measure(seed):
    images = np.random.default_rng(seed).integers(0, 256, (3, 40, 70), dtype=np.uint8)
    for verdict in mtb.verdicts(images):
        assert verdict.after <= verdict.before
        assert verdict.offset == (0, 0) or verdict.after < verdict.before


@pytest.mark.parametrize("shape", [(1, 1), (1, 300), (10, 10), (17, 63), (16, 64)])
def test_small_frames_are_no_error(shape):
    images = np.random.default_rng(0).integers(0, 256, (3, *shape), dtype=np.uint8)
    offsets = mtb.align(images)
    assert offsets.shape == (3, 2) and np.all(np.abs(offsets) < np.array(shape))


def test_the_chain_sums_the_pairs_and_breaks_where_one_is_not_informative():
    def seen(moving, fixed, offset):
        return pairs.Verdict(moving, fixed, offset, 0.1, 0.0, 1.0, True, "")

    verdicts = [seen(4, 0, (1, 2)), seen(0, 3, (10, 20)), seen(3, 1, (100, 0)), seen(1, 2, (0, 5))]
    assert pairs.along(verdicts).tolist() == [[10, 20], [-100, 0], [-100, -5], [0, 0], [11, 22]]
    verdicts[1] = pairs.blind(0, 3)
    assert pairs.along(verdicts).tolist() == [[0, 0], [-100, 0], [-100, -5], [0, 0], [1, 2]]


# what cannot be aligned


def test_a_frame_whose_median_is_white_is_aligned_by_another_percentile():
    images = bracket([(0, 0), (5, -3)], [4, 16])
    assert np.median(images[1, ..., 1]) == 255
    assert mtb.align(images).tolist() == [[-5, 3], [0, 0]]


def test_a_frame_whose_median_is_black_is_aligned_by_another_percentile():
    images = bracket([(0, 0), (5, -3)], [1, 4], noise=0) // 2
    images = np.where(images < 64, 0, images - 64).astype(np.uint8)
    assert np.median(images[0, ..., 1]) == 0
    assert mtb.align(images).tolist() == [[-5, 3], [0, 0]]


def test_frames_saturated_to_96_percent_stay_where_they_are():
    images = bracket([(0, 0), (0, 0)], [1, 1.5], noise=0).astype(float)
    images = np.clip(images - np.quantile(images[0, ..., 1], 0.04) + 255, 0, 255).astype(np.uint8)
    assert np.mean(images[0, ..., 1] == 255) > 0.95
    assert not mtb.align(images).any()


@pytest.mark.parametrize("level", [0, 255])
def test_a_black_or_white_frame_is_reported_and_stays(level):
    images = bracket([(0, 0), (6, 6), (0, 0)], [1, 4, 1])
    images[2] = level
    offsets, verdicts = mtb.align(images), mtb.verdicts(images)
    told = [verdict for verdict in verdicts if 2 in (verdict.moving, verdict.fixed)]
    assert [verdict.informative for verdict in told] == [False]
    assert "uninformative" in told[0].trouble and not told[0].reliable
    assert offsets[2].tolist() == [0, 0]
    assert (offsets[1] - offsets[0]).tolist() == [6, 6]


def test_frames_without_any_texture_are_reported():
    images = np.stack([np.full((64, 80), level, np.uint8) for level in (60, 120, 240)])
    assert not mtb.align(images).any()
    assert not any(verdict.informative for verdict in mtb.verdicts(images))


def test_stripes_which_do_not_tell_how_far_along_them_are_reported():
    stripes = gaussian_filter1d(np.random.default_rng(0).standard_normal(300), 4)
    stripes = np.tile(stripes / np.abs(stripes).max(), (200, 1))
    images = np.stack([60 + 40 * stripes, 120 + 80 * stripes]).astype(np.uint8)
    (verdict,) = mtb.verdicts(images)
    assert verdict.offset == (0, 0) and "2 pixels away" in verdict.trouble


@pytest.mark.parametrize("texture", [astronaut, coffee])
@pytest.mark.parametrize("degrees", [-3, 1.5, 2])
def test_a_rotation_is_reported(texture, degrees):
    images = bracket([(0, 0), (3, -5)], [1, 4], texture=texture())
    images[1] = rotate(images[1], degrees, axes=(0, 1), reshape=False, order=1, mode="reflect")
    (verdict,) = mtb.verdicts(images)
    assert verdict.informative and not verdict.reliable


@pytest.mark.parametrize("period", [8, 2.6666666666666665])
def test_a_picture_that_repeats_itself_is_reported_in_words_that_are_true(period):
    y, x = np.indices((208, 308)) * 2 * np.pi / period
    waves = 120 + 90 * np.sin(x + 0.3) * np.sin(y + 0.7)
    (verdict,) = mtb.verdicts(np.stack([waves[8:], waves[6:-2]]).astype(np.uint8))
    assert verdict.informative and not verdict.reliable
    assert verdict.trouble == "the picture repeats itself: 8 pixels away the photographs fit as well"


def test_a_motion_beyond_the_range_is_reported():
    (verdict,) = mtb.verdicts(bracket([(0, 0), (60, -69)], [1, 4]), bits=5)
    assert not verdict.reliable


def test_textures_so_fine_that_nothing_corresponds_are_reported():
    images = np.random.default_rng(0).integers(0, 256, (2, 200, 300), dtype=np.uint8)
    (verdict,) = mtb.verdicts(images)
    assert verdict.offset == (0, 0)
    assert verdict.confidence < 0.1 and "fit nearly as well" in verdict.trouble


def test_an_offset_that_is_right_is_not_doubted():
    for offset in ((0, 0), (1, 0), (13, -22), (-40, 17)):
        (verdict,) = mtb.verdicts(bracket([(0, 0), offset], [1, 4]))
        assert verdict.reliable and verdict.confidence > 0.6 and verdict.trouble == ""


@pytest.mark.parametrize(
    "images, bits",
    [
        (np.zeros((2, 8, 8)), 6),
        (np.zeros((8, 8), np.uint8), 6),
        (np.zeros((2, 8, 8, 4), np.uint8), 6),
        ([np.zeros((8, 8), np.uint8), np.zeros((8, 9), np.uint8)], 6),
        (np.zeros((2, 8, 8), np.uint8), 0),
    ],
)
def test_what_is_not_a_stack_of_photographs_is_refused(images, bits):
    for verb in (mtb.align, mtb.verdicts, lambda *a, **k: list(mtb.align_steps(*a, **k))):
        with pytest.raises(ValueError, match="expected"):
            verb(images, bits=bits)


# real photographs


def photographs(folder):
    return np.stack([iio.imread(path) for path in sorted(folder.glob("*.jp*g"))])


def features(Y):
    """Return the key points of a gray photograph and what they look like [SIFT]."""
    flat = cv2.createCLAHE(4.0, (8, 8)).apply(Y)
    return cv2.SIFT_create(3000, contrastThreshold=0.01).detectAndCompute(flat, None)


def motion(fixed, moving):
    """Return the median (dy, dx) of the features that two photographs share [RANSAC]."""
    matches = cv2.BFMatcher().knnMatch(moving[1], fixed[1], k=2)
    good = [one for one, other in matches if one.distance < 0.7 * other.distance]
    start = np.float32([moving[0][match.queryIdx].pt for match in good])
    end = np.float32([fixed[0][match.trainIdx].pt for match in good])
    _, inliers = cv2.estimateAffinePartial2D(start, end, ransacReprojThreshold=2)
    return np.median((end - start)[inliers.ravel() > 0], axis=0)[::-1]


def test_the_arch_is_aligned_to_a_pixel_of_what_its_features_say(shared):
    images = photographs(shared("stlouis_arch"))
    seen = [features(image[1000:, :, 1]) for image in images]
    for verdict in mtb.verdicts(images):
        measured = motion(seen[verdict.fixed], seen[verdict.moving])
        assert np.abs(measured - verdict.offset).max() < 1
        assert verdict.reliable and verdict.after < verdict.before


@pytest.mark.parametrize("name", ["window", "frobisher", "mertens_house"])
def test_photographs_from_a_tripod_stay(shared, name):
    images = photographs(shared(name))
    assert not mtb.align(images).any()
    assert all(verdict.reliable for verdict in mtb.verdicts(images))


def test_a_walk_around_the_crusader_is_reported_pair_by_pair(shared):
    verdicts = mtb.verdicts(photographs(shared("crusader") / "frames"))
    assert len(verdicts) == 6
    assert not any(verdict.reliable for verdict in verdicts)
    assert max(verdict.confidence for verdict in verdicts) < 0.2


def test_a_phone_that_turned_is_reported_and_one_that_did_not_is_aligned(shared):
    verdicts = mtb.verdicts(photographs(shared("tripod_phone")))
    assert all(verdict.after < verdict.before / 2 for verdict in verdicts)
    turned = [verdict for verdict in verdicts if not verdict.reliable]
    assert turned and all("quarters" in verdict.trouble for verdict in turned)
    (still,) = (verdict for verdict in verdicts if verdict.reliable)
    assert still.offset == (-4, 0)
