"""The longest photo limits the radiance of pixels that are dark in every photo."""

import numpy as np
import pytest

from hdrlab.capture import camera
from hdrlab.capture.responses import true_g
from hdrlab.core.weights import gaussian
from hdrlab.fast.merge import merge_with_quality
from hdrlab.pipeline import dark_pixels, merging

# exposure of each pixel value of a linear camera
LINEAR = np.log(np.maximum(np.arange(256), 0.5))
TIMES = np.array([1.0, 4.0])


def merge(images, *, method="shot", noise=1.0, times=TIMES, **options):
    """Return the map of photos by a linear camera."""
    merged = merging.merge_photos(
        np.asarray(images, np.uint8), times, LINEAR, method=method, noise=noise, **options
    )
    return merged.E


@pytest.mark.parametrize("method", ["shot", "likelihood"])
def test_a_pixel_that_the_longest_photo_shows_black_is_dark(method):
    # 2 in the longest photo is as much as noise makes of a black pixel
    assert merge([[[3]], [[0]]], method=method)[0, 0] <= 2 / 4
    assert merge([[[3]], [[0]]], method="log")[0, 0] == pytest.approx(3)


def test_pixels_that_a_shorter_photo_measures_keep_their_radiance():
    moved = [[[60]], [[0]]]
    assert merge(moved)[0, 0] == pytest.approx(60)


def test_the_longest_photo_is_no_limit_where_it_shows_nothing_of_the_scene():
    valid = np.array([[[True]], [[False]]])
    assert merge([[[3]], [[0]]], valid=valid)[0, 0] == pytest.approx(3)


def test_the_brightest_of_several_long_photos_is_the_limit():
    images = [[[0]], [[0]], [[6]]]
    merged = merge(images, times=np.array([1.0, 4.0, 4.0]))
    assert merged[0, 0] == pytest.approx(6 / 4)


def test_a_stuck_pixel_keeps_the_radiance_of_its_neighbors():
    images = np.array([10, 15])[:, None, None] * np.ones((2, 9, 9))
    images[:, 4, 4] = 1
    times = np.array([1.0, 1.5])
    repaired = merge_with_quality(images.astype(np.uint8), times, LINEAR, method="shot").E
    np.testing.assert_allclose(merge(images, times=times), repaired)


def test_16_bit_photos_have_the_limit_of_8_bit_photos():
    images = np.array([[[3]], [[0]]], np.uint16) * 257
    g = np.log(np.maximum(np.arange(65536), 128) / 257)
    merged = merging.merge_photos(images, TIMES, g, method="shot", noise=257.0)
    assert merged.E[0, 0] <= 2 / 4


def test_noise_of_short_photos_does_not_brighten_the_dark_part_of_a_night():
    rng = np.random.default_rng(1)
    E = (0.002 * 2 ** rng.uniform(-1, 1, (96, 128, 1)) * [1, 0.5, 0.2]).astype(np.float32)
    times = np.array([0.0025, 0.01, 0.04, 0.16])
    sensor = camera.Camera(response="gamma", full_well=20_000, read_noise=5)
    taken = camera.shoot(E, times, sensor, rng=2)
    g = true_g("gamma")
    noise = dark_pixels.measure_noise(taken.images[-1])
    limited = merging.merge_photos(taken.images, times, g, gaussian(), method="shot", noise=noise).E
    plain = merge_with_quality(taken.images, times, g, gaussian(), method="shot").E

    def measure_blue_error(merged):
        ratios = np.log2(merged[..., 2] / merged[..., 0]) - np.log2(0.2)
        return abs(np.median(ratios))

    assert measure_blue_error(limited) < 0.65 * measure_blue_error(plain)
