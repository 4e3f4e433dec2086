"""Robertson's iterations as products with one matrix, the penalty that connects a period, and the curves."""

from functools import partial

import numpy as np
import pytest
from hypothesis import given, strategies as st
from support import laws

from hdrlab.capture import camera, responses
from hdrlab.core import sampling, weights
from hdrlab.fast import robertson
from hdrlab.response import robertson as lesson

CURVES = sorted(responses.RESPONSES)
WEIGHTS = weights.cut(weights.gaussian(), below=0.02)
smooth = partial(robertson.recover, steps=robertson.Smooth(100))  # as the pipeline asks


def samples(N=500, P=4, seed=0, top=255):
    """Return Z (N, P) of any levels and t (P,)."""
    rng = np.random.default_rng(seed)
    return rng.integers(0, top + 1, (N, P)), rng.uniform(0.1, 1, P)


@given(seed=st.integers(0, 99), P=st.integers(2, 6), N=st.integers(1, 400))
def test_the_matrix_product_equals_irradiance_and_update_of_the_lesson(seed, P, N):
    Z, t = samples(N, P, seed)
    f_inv = np.sort(np.random.default_rng(seed).uniform(0, 2, 256))
    looped = lesson.update(Z, t, lesson.irradiance(Z, t, f_inv, WEIGHTS))
    product = robertson.Joint(Z, t, WEIGHTS)(f_inv)
    assert np.allclose(product, looped, rtol=1e-10, equal_nan=True)


def test_the_matrix_is_the_sum_of_the_matrices_of_its_parts():
    Z, t = samples(70_000)
    whole = robertson.Joint(Z, t, WEIGHTS)
    parts = [robertson.Joint(some, t, WEIGHTS) for some in np.array_split(Z, 7)]
    assert np.allclose(sum(part.S for part in parts), whole.S)
    assert np.array_equal(sum(part.pixels for part in parts), whole.pixels)


@pytest.mark.parametrize("smoothness", [0.1, 10, 1000])
def test_smoothing_leaves_the_straight_response_of_a_linear_camera_straight(smoothness, decades):
    E = decades((60, 80))
    taken = camera.shoot(E, camera.times_around(E, 7, stops=1), camera.Camera(response=lambda X: X))
    g = robertson.recover(taken.images, taken.times, steps=robertson.Smooth(smoothness))
    assert laws.curve_error(g, responses.true_g(lambda X: X)) < 0.01


# The curves


@pytest.mark.parametrize("name", CURVES)
def test_seven_frames_give_the_response_to_three_tenths_of_a_percent(name, seven_frames):
    _, taken = seven_frames(name)
    g = smooth(taken.images, taken.times)
    assert laws.curve_error(g, responses.true_g(name)) < 0.003


def test_without_smoothness_frames_2_stops_apart_leave_the_start_in_the_curve(decades):
    """The ambiguity of equal steps: 4 % at 2 stops, 0.5 % at 1 stop; uneven steps remove it."""
    E = decades(seed=3)
    curves = []
    for stops in (
        np.arange(7) * 2.0,
        np.arange(7) * 1.0,
        np.cumsum([0, 1, 2.3, 1.4, 0.7, 2.6, 1.2]),
    ):
        times = camera.times_around(E, 1)[0] * 2.0 ** (stops - stops.mean())
        taken = camera.shoot(
            E, times, camera.Camera(response="gamma", full_well=50_000, read_noise=5), rng=3
        )
        g = robertson.recover(
            taken.images, taken.times, steps=partial(robertson.recover_steps, max_iterations=50)
        )
        curves.append(laws.curve_error(g, responses.true_g("gamma")))
    assert 0.02 < curves[0] < 0.045 and curves[1] < 0.006 and curves[2] < 0.6 * curves[0]


@pytest.mark.parametrize("name", CURVES)
def test_4000_samples_are_as_accurate_as_all_pixels(name, seven_frames):
    _, taken = seven_frames(name)
    truth = responses.true_g(name)
    some = laws.curve_error(smooth(taken.images, taken.times, samples=4000), truth)
    every = laws.curve_error(smooth(taken.images, taken.times, choose=sampling.every_pixel), truth)
    assert some < every + 5e-4


def test_cut_weights_keep_noise_from_bending_the_curve(decades):
    E = decades(seed=1)
    knobs = dict(full_well=5000, read_noise=5, gray_noise=1.0)
    taken = camera.shoot(
        E, camera.times_around(E, 7, stops=2), camera.Camera(response="linear", **knobs), rng=1
    )
    usual = laws.curve_error(
        smooth(taken.images, taken.times, w=weights.gaussian()), responses.true_g("linear")
    )
    cut = laws.curve_error(smooth(taken.images, taken.times, w=WEIGHTS), responses.true_g("linear"))
    assert cut < 0.005 and usual > 10 * cut


def test_masked_pixels_do_not_change_the_curve(decades):
    E = decades((60, 80))
    taken = camera.shoot(E, camera.times_around(E, 5, stops=2))
    images = taken.images.copy()
    valid = np.ones(taken.images.shape, bool)
    images[1:3, :, :20] = 90
    valid[1:3, :, :20] = False
    for choose in (sampling.by_rank, sampling.every_pixel):
        g = smooth(taken.images[:, :, 20:], taken.times, choose=choose)
        hidden = smooth(images, taken.times, choose=choose, valid=valid)
        assert np.allclose(hidden, g, atol=1e-9)


def test_each_channel_is_recovered_independently(decades):
    E = decades((40, 50))
    times = camera.times_around(E, 5, stops=1.5)
    gray = [
        camera.shoot(E, times, camera.Camera(response=name)).images
        for name in ("film", "gamma", "linear")
    ]
    g = smooth(np.stack(gray, axis=-1), times, choose=sampling.every_pixel)
    for c, images in enumerate(gray):
        assert np.allclose(g[:, c], smooth(images, times, choose=sampling.every_pixel), atol=1e-9)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"images": "one"}, "well exposed in two photos"),
        ({"times": [1, 1]}, "well exposed in two photos"),
        ({"images": "black"}, "well exposed in two photos"),
        ({"images": "white"}, "well exposed in two photos"),
        ({"times": [1, 0]}, "positive exposure times"),
    ],
)
def test_brackets_without_two_exposures_raise_an_error(changes, message):
    stack = np.tile(np.arange(256, dtype=np.uint8).reshape(16, 16), (2, 1, 1))
    stacks = {"one": stack[:1], "black": stack * 0, "white": stack * 0 + 255}
    knobs = {"images": stack, "times": [1, 2]} | changes
    if isinstance(knobs["images"], str):
        knobs["images"] = stacks[knobs["images"]]
        knobs["times"] = knobs["times"][: len(knobs["images"])]
    with pytest.raises(ValueError, match=message):
        smooth(**knobs)


@pytest.mark.parametrize("smoothness", [-1, np.nan, np.inf])
def test_an_invalid_smoothness_raises_an_error(smoothness):
    with pytest.raises(ValueError, match="smoothness that is finite and not negative"):
        robertson.Smooth(smoothness)
