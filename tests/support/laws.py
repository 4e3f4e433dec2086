"""Properties that all tone-mapping operators, or all methods that recover a response, must have.

Each law is a function that takes the operator or the method and asserts one property. Every operator
must obey the laws of ALWAYS, and those of CLAIMED that its module names in LAWS (see hdrlab.tonemap).
RECOVERY, CALIBRATION and CONSISTENCY, at the end, are the laws of response recovery.
"""

from functools import cache

import numpy as np
import pytest

from hdrlab.capture import camera, responses
from hdrlab.course.checks.laws import (
    RADIANCES,
    answers_the_same_twice,
    curve_error,
    exposure,
    hot_pixel,
    keeps_the_light_the_right_way_up,
    scene,
    stays_in_range,
    takes_any_memory_layout,
)
from hdrlab.errors import InputError


def refuses_and_counts_invalid_radiance(tonemap):
    for value, message in ((np.nan, "2 NaN"), (np.inf, "2 infinite"), (-1.0, "2 negative")):
        L = scene()
        L[3, 4] = value
        L[50, 60] = value
        with pytest.raises(ValueError, match=message):
            tonemap(L)


def refuses_wrong_shapes(tonemap):
    for shape in ((), (5,), (4, 5, 3), (2, 4, 5, 3), (0, 5)):
        with pytest.raises(ValueError, match="luminance"):
            tonemap(np.ones(shape))
    with pytest.raises(ValueError, match="luminance"):
        tonemap(np.full((4, 5), "bright"))


def does_not_change_its_input(tonemap):
    L = scene()
    L.setflags(write=False)
    Ld = tonemap(L)
    assert np.array_equal(L, scene())
    assert not np.shares_memory(L, Ld)


def is_robust_against_a_hot_pixel(tonemap):
    """One hot pixel changes the median of the image by less than 0.02."""
    for L in (scene(), scene((64, 64), 1) ** 0.2):
        change = np.median(tonemap(hot_pixel(L))) - np.median(tonemap(L))
        assert abs(change) < 0.02


def monotone(tonemap):
    """A brighter pixel is never darker on the display: one rising curve holds for all pixels."""
    scenes = (
        scene(),
        RADIANCES["a scene with zeros"],
        RADIANCES["the range of float32"],
        hot_pixel(scene()),
    )
    for L in scenes:
        order = np.argsort(L, axis=None)
        assert np.all(np.diff(tonemap(L).ravel()[order]) >= -1e-6)  # float32 rounds


ALWAYS = (
    stays_in_range,
    refuses_and_counts_invalid_radiance,
    refuses_wrong_shapes,
    answers_the_same_twice,
    does_not_change_its_input,
    takes_any_memory_layout,
    is_robust_against_a_hot_pixel,
    keeps_the_light_the_right_way_up,
)
CLAIMED = {"monotone": monotone, "exposure": exposure}


# Laws of response recovery


def simulate_bracket(response, *, shape=(60, 80), frames=7, bits=8, rng=11):
    """Return a Bracket of a scene of five decades, 2 stops apart, with the noise of a large sensor."""
    E = (10.0 ** np.random.default_rng(rng).uniform(-2.5, 2.5, shape)).astype(np.float32)
    times = camera.times_around(E, frames, stops=2)
    large_sensor = camera.Camera(response=response, bits=bits, full_well=50_000, read_noise=5)
    return camera.shoot(E, times, large_sensor, rng=rng)


@cache
def recover_cached(recover, response):
    """Return the curve that a method recovers from the default photos; several laws need it."""
    taken = simulate_bracket(response)
    g = recover(taken.images, taken.times)
    g.setflags(write=False)
    return g


def finds_the_true_curve_of_a_simulated_camera(recover, response):
    for bits in (8, 16):
        taken = simulate_bracket(response, bits=bits)
        g = recover(taken.images, taken.times)
        assert curve_error(g, responses.true_g(response, len(g))) < 0.01, f"{bits} bits"


def returns_one_value_per_level_with_0_at_the_middle_level(recover, response):
    for shape, channels in (((60, 80), ()), ((60, 80, 3), (3,))):
        taken = simulate_bracket(response, shape=shape)
        g = recover(taken.images, taken.times)
        assert g.shape in {(256,), (256, *channels)}
        assert g.dtype == np.float64
        assert_rising_curve(g)


def does_not_depend_on_the_order_of_the_photos(recover, response):
    taken = simulate_bracket(response)
    order = np.random.default_rng(0).permutation(len(taken.times))
    shuffled = recover(taken.images[order], taken.times[order])
    assert np.allclose(shuffled, recover_cached(recover, response), atol=1e-8)


def does_not_depend_on_the_unit_of_time(recover, response):
    taken = simulate_bracket(response)
    for factor in (2, 1 / 3000):
        g = recover(taken.images, factor * taken.times)
        assert np.allclose(g, recover_cached(recover, response), atol=1e-8)


def recovers_the_same_curve_from_8_bits_stored_in_16(recover, response):
    taken = simulate_bracket(response)
    g = recover(taken.images.astype(np.uint16) * 257, taken.times)
    eight = recover_cached(recover, response)
    if len(g) == 256:
        assert np.allclose(g, eight, atol=1e-12)
    else:
        shared = g[257:-257:257]
        assert np.allclose(shared - shared[127], eight[1:-1] - eight[128], atol=1e-6)


def recovers_gray_like_each_of_three_equal_channels(recover, response):
    taken = simulate_bracket(response)
    gray = recover_cached(recover, response)
    rgb = recover(np.stack([taken.images] * 3, axis=-1), taken.times)
    assert np.allclose(rgb.reshape(len(gray), -1), gray[:, None], atol=1e-10)


def works_with_two_photos(recover, response):
    E = np.geomspace(0.02, 1, 4800, dtype=np.float32).reshape(60, 80)
    taken = camera.shoot(E, [0.5, 1.0], camera.Camera(response=response))
    g = recover(taken.images, taken.times)
    assert curve_error(g, responses.true_g(response, len(g))) < 0.05


def works_with_levels_that_no_pixel_has(recover, response):
    taken = simulate_bracket(response)
    images = taken.images // 2 * 2  # even levels only
    g = recover(images, taken.times)
    assert np.all(np.isfinite(g)) and curve_error(g, responses.true_g(response, len(g))) < 0.02


def does_not_change_the_photos(recover, response):
    taken = simulate_bracket(response)
    images = taken.images.copy()
    times = taken.times.copy()
    images.setflags(write=False)
    times.setflags(write=False)
    assert np.array_equal(recover(images, times), recover_cached(recover, response))
    assert np.array_equal(images, taken.images) and np.array_equal(times, taken.times)


def refuses_invalid_brackets(recover, response):
    taken = simulate_bracket(response)
    for images, times in (
        (taken.images, taken.times[1:]),
        (taken.images, taken.times * 0),
        (taken.images.astype(float), taken.times),
        (taken.images[..., None], taken.times),
    ):
        with pytest.raises(InputError):
            recover(images, times)


def refuses_a_single_photo_and_equal_times(recover, response):
    taken = simulate_bracket(response)
    for images, times in ((taken.images[:1], taken.times[:1]), (taken.images[:3], [0.1, 0.1, 0.1])):
        with pytest.raises(InputError):
            recover(images, times)


def refuses_photos_without_a_common_level(recover, response):
    flat = np.full((40, 50), 1, np.uint8)
    ramp = np.broadcast_to(np.arange(100, 150), (40, 50)).astype(np.uint8)
    for frames in (
        (0 * flat, 255 * flat),
        (2 * flat, 254 * flat),
        (ramp, 255 * flat),
        (0 * flat, ramp),
    ):
        with pytest.raises(InputError):
            recover(np.stack(frames), [1.0, 4.0])


def refuses_times_that_are_wrong_by_a_factor_of_100(recover, response):
    """One, several or all times are wrong; the photos contradict them, or no camera has such a response."""
    taken = simulate_bracket(response)
    images = taken.images
    times = taken.times
    # with linear photos, a factor of 100 would look like a camera of gamma 4.3
    factor = 10_000 if response == "linear" else 100
    off = float(factor) ** np.arange(len(times))
    for frames, wrong in (
        (images, times * np.r_[1 / factor, np.ones(len(times) - 1)]),
        (images, times * np.r_[np.ones(len(times) - 1), factor]),
        (images, times * off),
        (images[2:5], times[2:5] * [1, factor, 1]),
        (images[3:5], times[3:5] * [1, factor]),
        (images[3:5], times[3:5] * [factor, 1]),
    ):
        with pytest.raises(InputError):
            recover(frames, wrong)


def refuses_frames_in_the_wrong_order(recover, response):
    taken = simulate_bracket(response)
    with pytest.raises(InputError):
        recover(taken.images[::-1], taken.times)


def returns_a_rising_curve_or_an_error_for_nonsense(recover, response):
    """No camera takes such photos of one scene: constant, equal, random, or with a falling response."""
    taken = simulate_bracket(response)
    rng = np.random.default_rng(0)
    images = taken.images[2:5]
    times = taken.times[2:5]
    rising_then_falling = (255 - np.abs(2 * images.astype(int) - 255)).astype(np.uint8)
    for nonsense in (
        np.full_like(images, 100),
        np.stack([np.full_like(images[0], z) for z in (60, 100, 140)]),
        images[[1, 1, 1]],
        rng.integers(0, 256, images.shape, dtype=np.uint8),
        rng.permuted(images, axis=2),
        rising_then_falling,
        np.where(images > 128, 255, 0).astype(np.uint8),
    ):
        try:
            g = recover(nonsense, times)
        except ValueError as error:
            assert "expected" in str(error)
        else:
            assert_rising_curve(g)


def assert_rising_curve(g):
    """Assert that a curve is finite, never falls, and is 0 at the middle level."""
    assert np.all(np.isfinite(g))
    assert np.all(np.diff(g, axis=0) >= 0)
    assert np.all(g[128] == 0)


# for all methods
RECOVERY = (
    finds_the_true_curve_of_a_simulated_camera,
    returns_one_value_per_level_with_0_at_the_middle_level,
    does_not_depend_on_the_order_of_the_photos,
    does_not_depend_on_the_unit_of_time,
    recovers_the_same_curve_from_8_bits_stored_in_16,
    recovers_gray_like_each_of_three_equal_channels,
    works_with_two_photos,
    works_with_levels_that_no_pixel_has,
    does_not_change_the_photos,
    refuses_invalid_brackets,
)
# for methods that estimate the response from the photos
CALIBRATION = (
    refuses_a_single_photo_and_equal_times,
    refuses_photos_without_a_common_level,
    returns_a_rising_curve_or_an_error_for_nonsense,
)
# for a response that was validated against its photos
CONSISTENCY = (
    refuses_times_that_are_wrong_by_a_factor_of_100,
    refuses_frames_in_the_wrong_order,
)
