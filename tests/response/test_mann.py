"""Mann and Picard's power law: repeated comparisons and the slope of their line."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from support import laws

from hdrlab.capture import camera, responses
from hdrlab.errors import InputError
from hdrlab.response import mann


@given(gamma=st.floats(0.3, 1.5), R=st.floats(0.2, 0.8), start=st.floats(150, 249))
def test_each_level_of_descend_has_R_times_the_exposure_of_the_previous_one(gamma, R, start):
    T = np.arange(256) * R**gamma
    levels = mann.descend(T, start)
    assert np.allclose(levels, start * R ** (gamma * np.arange(len(levels))))
    assert levels[-1] * R**gamma < mann.MIN_LEVEL <= levels[-1]


@given(gamma=st.floats(0.3, 1.5), alpha=st.floats(0, 20), R=st.floats(0.3, 0.8))
def test_fit_exponent_finds_the_exponent_of_exact_levels(gamma, alpha, R):
    levels = alpha + 200 * R ** (gamma * np.arange(4))
    assert np.isclose(mann.fit_exponent([(levels, R), (levels[1:], R)], alpha=alpha), gamma)


def test_descend_stops_where_the_transfer_is_unknown_or_does_not_fall():
    T = np.where(np.arange(256) < 100, np.nan, np.arange(256) / 2)
    assert mann.descend(T, 240).tolist() == [240, 120, 60]
    assert mann.descend(np.full(256, np.nan), 240).tolist() == [240]
    assert mann.descend(np.arange(256.0), 240).tolist() == [240]  # it does not go down at all


@pytest.mark.parametrize("gamma", [1 / 2.4, 1 / 2.2, 0.8, 1.0, 1.3])
@pytest.mark.parametrize("seed", range(3))
def test_a_power_law_is_found_to_a_tenth_of_a_percent_through_noise(gamma, seed, decades):
    E = decades(seed=seed)
    knobs = dict(response=lambda X: X**gamma, full_well=50_000, read_noise=5)
    taken = camera.shoot(E, camera.times_around(E, 5, stops=2), camera.Camera(**knobs), rng=seed)
    g = mann.recover(taken.images, taken.times)
    assert laws.curve_error(g, mann.power_law(gamma)) < 0.001


def test_the_black_level_alpha_must_be_given(decades):
    E = decades()
    alpha = 20
    gamma = 0.6
    response = lambda X: alpha / 255 + (1 - alpha / 255) * X**gamma  # noqa: E731
    taken = camera.shoot(E, camera.times_around(E, 5, stops=2), camera.Camera(response=response))
    with_alpha = mann.recover(taken.images, taken.times, alpha=alpha)
    without_alpha = mann.recover(taken.images, taken.times, alpha=0)
    truth = mann.power_law(gamma, alpha=alpha)
    assert np.abs(with_alpha - truth)[40:].max() < 0.01
    assert np.abs(without_alpha - truth)[40:].max() > 0.1
    assert np.all(np.diff(with_alpha) >= 0) and np.all(np.isfinite(with_alpha))


@pytest.mark.parametrize(("name", "low", "high"), [("srgb", 0.005, 0.05), ("film", 0.03, 0.2)])
def test_for_a_camera_that_is_no_power_law_the_error_is_within_known_bounds(
    name, low, high, seven_frames
):
    _, taken = seven_frames(name)
    g = mann.recover(taken.images, taken.times)
    assert low < laws.curve_error(g, responses.true_g(name)) < high


def test_photos_without_clipped_pixels_work_too(decades):
    E = np.minimum(decades(), 1)
    taken = camera.shoot(
        E, [0.1, 0.2, 0.4], camera.Camera(response="gamma", full_well=50_000, read_noise=5), rng=0
    )
    assert taken.images.max() < 200
    g = mann.recover(taken.images, taken.times)
    assert laws.curve_error(g, responses.true_g("gamma")) < 0.005


def test_frames_need_not_be_aligned(seven_frames):
    _, taken = seven_frames("gamma")
    turned = np.stack([image[:: 1 - 2 * (j % 2)] for j, image in enumerate(taken.images)])
    assert np.array_equal(
        mann.recover(turned, taken.times), mann.recover(taken.images, taken.times)
    )


STACK = np.tile(np.arange(256, dtype=np.uint8).reshape(16, 16), (2, 1, 1))


@pytest.mark.parametrize(
    ("images", "times", "knobs"),
    [
        (STACK[:1], [1], {}),
        (STACK, [1, 1], {}),
        (STACK * 0, [1, 2], {}),
        (STACK * 0 + 255, [1, 2], {}),
        (STACK[::1], [1, 2], {"alpha": -1}),
        (STACK, [1, 2], {"starts": 0}),
    ],
)
def test_brackets_without_two_exposures_raise_an_error(images, times, knobs):
    with pytest.raises(InputError):
        mann.recover(images, times, **knobs)


def test_level_0_of_a_power_law_stands_for_a_quarter_of_a_level():
    """Level 0 means between 0 and half a level of light; a quarter is the middle of this range."""
    for gamma in (1.0, 0.45):
        assert mann.power_law(gamma)[0] == pytest.approx(np.log(0.25 / 128) / gamma)


@pytest.mark.parametrize(("name", "value"), [("alpha", -1), ("alpha", 65), ("start", 0)])
def test_an_alpha_or_a_number_of_starts_out_of_range_raises_an_error(name, value):
    options = {"starts": value} if name == "start" else {name: value}
    with pytest.raises(ValueError, match=f"{name}.* got {value}"):
        mann.recover(np.zeros((2, 4, 4), np.uint8), [1, 2], **options)
