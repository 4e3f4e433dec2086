"""What registration by bitmaps promises the command line: offsets, and a reason where one is not right."""

import cv2
import imageio.v3 as iio
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from scipy.ndimage import gaussian_filter1d, rotate
from skimage.data import astronaut, coffee
from support.hand_held_photos import bracket

from hdrlab.pipeline.alignment import best_percentile, photograph_pairs, register

pytestmark = pytest.mark.papers


def offsets_of(images, method="mtb"):
    """Return the offsets (P, 2) that the pipeline finds."""
    return register(images, method).homographies[:, 1::-1, 2]


def validations(images, bits=6):
    return tuple(best_percentile(*both) for both in photograph_pairs(images, bits))


@pytest.mark.parametrize("seed", range(4))
def test_seven_frames_of_twelve_stops_are_aligned_through_their_neighbours(seed):
    rng = np.random.default_rng(seed)
    true = np.cumsum(rng.integers(-9, 10, (7, 2)), axis=0)
    true -= true[3]
    images = bracket(
        true,
        4.0 ** np.arange(-3, 4),
        texture=[astronaut(), coffee()][seed % 2],
        decades=5.0,
        seed=seed,
    )
    assert np.abs(offsets_of(images) - true).max() <= 1
    assert all(one.informative for one in validations(images))


def test_identical_frames_stay_and_agree_entirely():
    images = np.repeat(bracket([(0, 0)], [1]), 3, axis=0)
    assert not offsets_of(images).any()
    for one in validations(images):
        assert (one.before, one.after, one.confidence, one.failure) == (0, 0, 1, "")


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=20, deadline=None)
def test_the_found_offset_never_has_a_larger_error_than_no_offset(seed):
    images = np.random.default_rng(seed).integers(0, 256, (3, 40, 70), dtype=np.uint8)
    for one in validations(images):
        assert one.after <= one.before
        assert one.offset == (0, 0) or one.after < one.before


@pytest.mark.parametrize("shape", [(1, 1), (1, 300), (10, 10), (17, 63), (16, 64)])
@pytest.mark.parametrize("method", ["mtb", "auto"])
def test_small_frames_are_aligned_without_an_error(shape, method):
    images = np.random.default_rng(0).integers(0, 256, (3, *shape), dtype=np.uint8)
    offsets = offsets_of(images, method)
    assert offsets.shape == (3, 2) and np.all(np.abs(offsets) < np.array(shape))


# what cannot be aligned


def test_a_frame_whose_median_is_white_is_aligned_by_another_percentile():
    images = bracket([(0, 0), (5, -3)], [4, 16])
    assert np.median(images[1, ..., 1]) == 255
    assert offsets_of(images).tolist() == [[-5, 3], [0, 0]]


def test_a_frame_whose_median_is_black_is_aligned_by_another_percentile():
    images = bracket([(0, 0), (5, -3)], [1, 4], noise=0) // 2
    images = np.where(images < 64, 0, images - 64).astype(np.uint8)
    assert np.median(images[0, ..., 1]) == 0
    assert offsets_of(images).tolist() == [[-5, 3], [0, 0]]


def test_frames_saturated_to_96_percent_stay_where_they_are():
    images = bracket([(0, 0), (0, 0)], [1, 1.5], noise=0).astype(float)
    images = np.clip(images - np.quantile(images[0, ..., 1], 0.04) + 255, 0, 255).astype(np.uint8)
    assert np.mean(images[0, ..., 1] == 255) > 0.95
    assert not offsets_of(images).any()


@pytest.mark.parametrize("level", [0, 255])
def test_a_black_or_white_frame_is_reported_and_stays(level):
    images = bracket([(0, 0), (6, 6), (0, 0)], [1, 4, 1])
    images[2] = level
    offsets, found = offsets_of(images), validations(images)
    told = [one for one in found if 2 in (one.moving, one.fixed)]
    assert [one.informative for one in told] == [False]
    assert "uninformative" in told[0].failure and not told[0].reliable
    assert offsets[2].tolist() == [0, 0]
    assert (offsets[1] - offsets[0]).tolist() == [6, 6]


def test_frames_without_any_texture_are_reported():
    images = np.stack([np.full((64, 80), level, np.uint8) for level in (60, 120, 240)])
    assert not offsets_of(images).any()
    assert not any(one.informative for one in validations(images))


def test_stripes_are_reported_because_shifts_along_them_are_ambiguous():
    stripes = gaussian_filter1d(np.random.default_rng(0).standard_normal(300), 4)
    stripes = np.tile(stripes / np.abs(stripes).max(), (200, 1))
    images = np.stack([60 + 40 * stripes, 120 + 80 * stripes]).astype(np.uint8)
    (one,) = validations(images)
    assert one.offset == (0, 0) and "2 pixels away" in one.failure


@pytest.mark.parametrize("texture", [astronaut, coffee])
@pytest.mark.parametrize("degrees", [-3, 1.5, 2])
def test_a_rotation_is_reported(texture, degrees):
    images = bracket([(0, 0), (3, -5)], [1, 4], texture=texture())
    images[1] = rotate(images[1], degrees, axes=(0, 1), reshape=False, order=1, mode="reflect")
    (one,) = validations(images)
    assert one.informative and not one.reliable


@pytest.mark.parametrize("period", [8, 2.6666666666666665])
def test_a_periodic_image_is_reported_with_the_period_it_has(period):
    y, x = np.indices((208, 308)) * 2 * np.pi / period
    waves = 120 + 90 * np.sin(x + 0.3) * np.sin(y + 0.7)
    (one,) = validations(np.stack([waves[8:], waves[6:-2]]).astype(np.uint8))
    assert one.informative and not one.reliable
    assert "8 pixels away" in one.failure
    assert ("repeats itself" in one.failure) == (period == 8)


def test_a_motion_beyond_the_range_is_reported():
    (one,) = validations(bracket([(0, 0), (60, -69)], [1, 4]), bits=5)
    assert not one.reliable


def test_textures_so_fine_that_nothing_corresponds_are_reported():
    images = np.random.default_rng(0).integers(0, 256, (2, 200, 300), dtype=np.uint8)
    (one,) = validations(images)
    assert one.offset == (0, 0)
    assert one.confidence < 0.1 and "fit nearly as well" in one.failure


def test_correct_offsets_give_no_warning():
    for offset in ((0, 0), (1, 0), (13, -22), (-40, 17)):
        (one,) = validations(bracket([(0, 0), offset], [1, 4]))
        assert one.reliable and one.confidence > 0.6 and one.failure == ""


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


def test_the_arch_is_aligned_within_a_pixel_of_feature_matching(shared):
    images = photographs(shared("stlouis_arch"))
    seen = [features(image[1000:, :, 1]) for image in images]
    for one in validations(images):
        measured = motion(seen[one.fixed], seen[one.moving])
        assert np.abs(measured - one.offset).max() < 1
        assert one.reliable and one.after < one.before


@pytest.mark.parametrize("name", ["window", "frobisher", "mertens_house"])
def test_photographs_from_a_tripod_stay(shared, name):
    images = photographs(shared(name))
    assert not offsets_of(images).any()
    assert all(one.reliable for one in validations(images))


def test_a_walk_around_the_crusader_is_reported_pair_by_pair(shared):
    found = validations(photographs(shared("crusader") / "frames"))
    assert len(found) == 6
    assert not any(one.reliable for one in found)
    assert any(one.apart for one in found)


def test_rotated_phone_photos_are_reported_and_the_others_are_aligned(shared):
    found = validations(photographs(shared("tripod_phone")))
    assert all(one.after < one.before / 2 for one in found)
    turned = [one for one in found if not one.reliable]
    assert turned and all("quarters" in one.failure for one in turned)
    (still,) = (one for one in found if one.reliable)
    assert still.offset == (-4, 0)
