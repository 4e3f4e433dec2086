"""What every operator must obey, whatever its paper: each law takes the operator as an argument.

Laws that hold for all stand in ALWAYS; the others are for modules that name them in LAWS (see
hdrlab.tonemap).
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


def refuses_and_counts_what_is_no_radiance(tonemap):
    for value, said in ((np.nan, "2 NaN"), (np.inf, "2 infinite"), (-1.0, "2 negative")):
        L = scene()
        L[3, 4] = L[50, 60] = value
        with pytest.raises(ValueError, match=said):
            tonemap(L)


def refuses_wrong_shapes(tonemap):
    for shape in ((), (5,), (4, 5, 3), (2, 4, 5, 3), (0, 5)):
        with pytest.raises(ValueError, match="luminance"):
            tonemap(np.ones(shape))
    with pytest.raises(ValueError, match="luminance"):
        tonemap(np.full((4, 5), "bright"))


def leaves_its_input_alone(tonemap):
    L = scene()
    L.setflags(write=False)
    Ld = tonemap(L)
    assert np.array_equal(L, scene()) and not np.shares_memory(L, Ld)


def shrugs_off_a_hot_pixel(tonemap):
    """One hot pixel hardly moves the median of the picture."""
    for L in (scene(), scene((64, 64), 1) ** 0.2):
        assert abs(np.median(tonemap(hot_pixel(L))) - np.median(tonemap(L))) < 0.02


def monotone(tonemap):
    """One curve for all pixels: a brighter pixel is never darker on the display."""
    for L in (
        scene(),
        RADIANCES["a scene with zeros"],
        RADIANCES["the range of float32"],
        hot_pixel(scene()),
    ):
        order = np.argsort(L, axis=None)
        assert np.all(np.diff(tonemap(L).ravel()[order]) >= -1e-6)  # float32 rounds


ALWAYS = (
    stays_in_range,
    refuses_and_counts_what_is_no_radiance,
    refuses_wrong_shapes,
    answers_the_same_twice,
    leaves_its_input_alone,
    takes_any_memory_layout,
    shrugs_off_a_hot_pixel,
    keeps_the_light_the_right_way_up,
)
CLAIMED = {"monotone": monotone, "exposure": exposure}


# The response


def photographs(response, *, shape=(60, 80), frames=7, bits=8, rng=11):
    """Return a Bracket of five decades of light, 2 stops apart, under the noise of a large sensor."""
    E = (10.0 ** np.random.default_rng(rng).uniform(-2.5, 2.5, shape)).astype(np.float32)
    times = camera.times_around(E, frames, stops=2)
    return camera.shoot(
        E,
        times,
        camera.Camera(response=response, bits=bits, full_well=50_000, read_noise=5),
        rng=rng,
    )


@cache
def recovered(recover, response):
    """Return what a method finds in the usual photographs: several laws compare with it, and it is dear."""
    taken = photographs(response)
    g = recover(taken.images, taken.times)
    g.setflags(write=False)
    return g


def finds_the_true_curve_of_a_simulated_camera(recover, response):
    for bits in (8, 16):
        taken = photographs(response, bits=bits)
        g = recover(taken.images, taken.times)
        assert curve_error(g, responses.true_g(response, len(g))) < 0.01, f"{bits} bits"


def answers_one_number_per_level_with_the_middle_at_0(recover, response):
    for shape, channels in (((60, 80), ()), ((60, 80, 3), (3,))):
        taken = photographs(response, shape=shape)
        g = recover(taken.images, taken.times)
        assert g.shape in {(256,), (256, *channels)} and g.dtype == np.float64
        assert np.all(np.isfinite(g)) and np.all(g[128] == 0) and np.all(np.diff(g, axis=0) >= 0)


def does_not_ask_for_an_order_of_the_frames(recover, response):
    taken = photographs(response)
    order = np.random.default_rng(0).permutation(len(taken.times))
    shuffled = recover(taken.images[order], taken.times[order])
    assert np.allclose(shuffled, recovered(recover, response), atol=1e-8)


def does_not_depend_on_the_unit_of_time(recover, response):
    taken = photographs(response)
    for factor in (2, 1 / 3000):
        g = recover(taken.images, factor * taken.times)
        assert np.allclose(g, recovered(recover, response), atol=1e-8)


def reads_16_bits_like_the_8_they_hold(recover, response):
    taken = photographs(response)
    g = recover(taken.images.astype(np.uint16) * 257, taken.times)
    eight = recovered(recover, response)
    if len(g) == 256:
        assert np.allclose(g, eight, atol=1e-12)
    else:
        shared = g[257:-257:257]
        assert np.allclose(shared - shared[127], eight[1:-1] - eight[128], atol=1e-6)


def recovers_gray_like_each_of_three_equal_channels(recover, response):
    taken = photographs(response)
    gray = recovered(recover, response)
    rgb = recover(np.stack([taken.images] * 3, axis=-1), taken.times)
    assert np.allclose(rgb.reshape(len(gray), -1), gray[:, None], atol=1e-10)


def makes_do_with_two_frames(recover, response):
    E = np.geomspace(0.02, 1, 4800, dtype=np.float32).reshape(60, 80)
    taken = camera.shoot(E, [0.5, 1.0], camera.Camera(response=response))
    g = recover(taken.images, taken.times)
    assert curve_error(g, responses.true_g(response, len(g))) < 0.05


def makes_do_with_levels_that_no_pixel_has(recover, response):
    taken = photographs(response)
    images = taken.images // 2 * 2  # the even ones alone
    g = recover(images, taken.times)
    assert np.all(np.isfinite(g)) and curve_error(g, responses.true_g(response, len(g))) < 0.02


def leaves_the_photographs_alone(recover, response):
    taken = photographs(response)
    images, times = taken.images.copy(), taken.times.copy()
    images.setflags(write=False)
    times.setflags(write=False)
    assert np.array_equal(recover(images, times), recovered(recover, response))
    assert np.array_equal(images, taken.images) and np.array_equal(times, taken.times)


def refuses_what_is_no_bracket(recover, response):
    taken = photographs(response)
    for images, times in (
        (taken.images, taken.times[1:]),
        (taken.images, taken.times * 0),
        (taken.images.astype(float), taken.times),
        (taken.images[..., None], taken.times),
    ):
        with pytest.raises(InputError):
            recover(images, times)


def refuses_one_photograph_and_times_that_are_all_alike(recover, response):
    taken = photographs(response)
    for images, times in ((taken.images[:1], taken.times[:1]), (taken.images[:3], [0.1, 0.1, 0.1])):
        with pytest.raises(InputError):
            recover(images, times)


def refuses_photographs_that_share_no_level(recover, response):
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
    """Whether the photographs contradict each other under them, or only every camera that there is."""
    taken = photographs(response)
    images, times = taken.images, taken.times
    factor = (
        10_000 if response == "linear" else 100
    )  # at 100 it would pass for a camera of gamma 4.3
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
    taken = photographs(response)
    with pytest.raises(InputError):
        recover(taken.images[::-1], taken.times)


def answers_nonsense_with_a_rising_curve_or_an_error(recover, response):
    """Photographs that no camera takes of one scene: constant, alike, noise, upside down in brightness."""
    taken, rng = photographs(response), np.random.default_rng(0)
    images, times = taken.images[2:5], taken.times[2:5]
    folded = (255 - np.abs(2 * images.astype(int) - 255)).astype(np.uint8)  # rises, then falls
    for nonsense in (
        np.full_like(images, 100),
        np.stack([np.full_like(images[0], z) for z in (60, 100, 140)]),
        images[[1, 1, 1]],
        rng.integers(0, 256, images.shape, dtype=np.uint8),
        rng.permuted(images, axis=2),
        folded,
        np.where(images > 128, 255, 0).astype(np.uint8),
    ):
        try:
            g = recover(nonsense, times)
        except ValueError as error:
            assert "expected" in str(error)
        else:
            assert (
                np.all(np.isfinite(g)) and np.all(np.diff(g, axis=0) >= 0) and np.all(g[128] == 0)
            )


RECOVERY = (
    finds_the_true_curve_of_a_simulated_camera,
    answers_one_number_per_level_with_the_middle_at_0,
    does_not_ask_for_an_order_of_the_frames,
    does_not_depend_on_the_unit_of_time,
    reads_16_bits_like_the_8_they_hold,
    recovers_gray_like_each_of_three_equal_channels,
    makes_do_with_two_frames,
    makes_do_with_levels_that_no_pixel_has,
    leaves_the_photographs_alone,
    refuses_what_is_no_bracket,
)
CALIBRATION = (  # of those that ask the photographs
    refuses_one_photograph_and_times_that_are_all_alike,
    refuses_photographs_that_share_no_level,
    answers_nonsense_with_a_rising_curve_or_an_error,
)
CONSISTENCY = (  # of a response that was validated against its photographs
    refuses_times_that_are_wrong_by_a_factor_of_100,
    refuses_frames_in_the_wrong_order,
)
