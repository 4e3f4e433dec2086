"""Robertson's response: the slide's two means, the table that replaces them, and the curves it finds."""

import laws
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hdrlab.capture import camera, responses
from hdrlab.core import sampling, weights
from hdrlab.core.steps import last
from hdrlab.response import joint, robertson

CURVES = sorted(responses.RESPONSES)
WEIGHTS = weights.cut(weights.gaussian(), below=0.02)


def samples(N=500, P=4, seed=0, top=255):
    """Return Z (N, P) of any levels and t (P,)."""
    rng = np.random.default_rng(seed)
    return rng.integers(0, top + 1, (N, P)), rng.uniform(0.1, 1, P)


# The equations


def test_irradiance_is_the_weighted_mean_of_the_slide():
    Z, t = np.array([[10, 100], [200, 250]]), np.array([0.5, 1.0])
    f, w = robertson.line(), weights.hat()
    for z, E in zip(Z, robertson.irradiance(Z, t, f, w), strict=True):
        assert np.isclose(E, sum(w[z] * f[z] * t) / sum(w[z] * t**2))


@given(seed=st.integers(0, 99), P=st.integers(2, 6), N=st.integers(1, 400))
def test_the_table_makes_the_turn_that_the_loop_over_pixels_makes(seed, P, N):
    Z, t = samples(N, P, seed)
    f = np.sort(np.random.default_rng(seed).uniform(0, 2, 256))
    looped = robertson.update(Z, t, robertson.irradiance(Z, t, f, WEIGHTS))
    turned = joint.turned(f, joint.table(Z, t, WEIGHTS), WEIGHTS)
    assert np.allclose(turned, np.nan_to_num(looped), rtol=1e-10)


def test_the_table_is_the_same_in_blocks(monkeypatch):
    Z, t = samples(3000)
    whole = joint.table(Z, t, WEIGHTS)
    monkeypatch.setattr(joint, "BLOCK", 700)
    parts = joint.table(Z, t, WEIGHTS)
    assert np.allclose(parts.S, whole.S) and np.array_equal(parts.pixels, whole.pixels)


@given(n=st.sampled_from([16, 256]), smoothness=st.floats(0.1, 1000))
def test_smoothing_leaves_a_straight_line_alone(n, smoothness):
    r = 3 + 0.5 * np.arange(n)
    smooth = robertson.smoother(np.zeros(n, bool), weights.hat(n), smoothness)
    assert np.allclose(smooth @ r, r, rtol=1e-6)


# Its steps


def test_each_state_keeps_the_gauge_and_says_how_much_it_changed():
    Z, t = samples(2000)
    states = list(robertson.recover_steps(Z, t, WEIGHTS, turns=6, tolerance=0))
    assert len(states) == 7 and all(state.f[128] == 1 for state in states)
    assert np.array_equal(states[0].f, robertson.line())
    for before, after in zip(states, states[1:], strict=False):
        assert after.change == np.abs(after.f - before.f).max()


def test_the_turns_end_at_the_tolerance_or_at_their_number(seven_frames):
    _, taken = seven_frames("gamma")
    Z = sampling.by_rank(taken.images, 4000)
    for tolerance in (1e-2, 1e-3):
        changes = [s.change for s in robertson.recover_steps(Z, taken.times, WEIGHTS, tolerance=tolerance)]
        assert changes[-1] < tolerance and all(change >= tolerance for change in changes[:-1])
    assert len(list(robertson.recover_steps(Z, taken.times, WEIGHTS, tolerance=0, turns=9))) == 10


def test_empty_levels_are_those_without_pixels_0_and_those_beyond_the_cut():
    Z = np.repeat(np.arange(0, 256, 2), 2).reshape(-1, 2)
    state = last(robertson.recover_steps(np.r_[Z, [[40, 80]]], [1, 2], WEIGHTS))
    expected = (np.arange(256) % 2 == 1) | (np.arange(256) >= 250) | (np.arange(256) == 0)
    assert np.array_equal(state.empty[6:], expected[6:])  # level 4 and below alone have no weight and no turn


def test_filling_interpolates_within_and_holds_the_last_value_beyond():
    f = np.array([9.0, 1, 7, 3, 4, 9, 9])
    empty = np.array([1, 0, 1, 0, 0, 1, 1], bool)
    assert robertson.fill(f, empty).tolist() == [0.25, 1, 2, 3, 4, 4, 4]


# The curves


@pytest.mark.parametrize("name", CURVES)
def test_seven_frames_give_the_response_to_three_tenths_of_a_percent(name, seven_frames):
    _, taken = seven_frames(name)
    g = robertson.recover(taken.images, taken.times)
    assert laws.curve_error(g, responses.true_g(name)) < 0.003


def test_without_smoothness_frames_2_stops_apart_leave_the_start_in_the_curve(decades):
    """The ambiguity of equal steps: 4 % at 2 stops, 0.5 % at 1 stop; uneven steps heal it."""
    E, found = decades(seed=3), []
    for stops in (np.arange(7) * 2.0, np.arange(7) * 1.0, np.cumsum([0, 1, 2.3, 1.4, 0.7, 2.6, 1.2])):
        times = camera.times_around(E, 1)[0] * 2.0 ** (stops - stops.mean())
        taken = camera.shoot(E, times, camera.Camera(response="gamma", full_well=50_000, read_noise=5), rng=3)
        g = robertson.recover(taken.images, taken.times, smoothness=0, turns=50)
        found.append(laws.curve_error(g, responses.true_g("gamma")))
    assert 0.02 < found[0] < 0.045 and found[1] < 0.006 and found[2] < 0.6 * found[0]


@pytest.mark.parametrize("name", CURVES)
def test_some_pixels_serve_as_well_as_all(name, seven_frames):
    _, taken = seven_frames(name)
    truth = responses.true_g(name)
    some = laws.curve_error(robertson.recover(taken.images, taken.times, samples=4000), truth)
    every = laws.curve_error(robertson.recover(taken.images, taken.times, samples=None), truth)
    assert some < every + 5e-4


def test_the_usual_weights_let_noise_bend_the_curve_and_the_cut_heals_it(decades):
    E = decades(seed=1)
    knobs = dict(full_well=5000, read_noise=5, gray_noise=1.0)
    taken = camera.shoot(
        E, camera.times_around(E, 7, stops=2), camera.Camera(response="linear", **knobs), rng=1
    )
    usual, cut = (
        laws.curve_error(robertson.recover(taken.images, taken.times, w=w), responses.true_g("linear"))
        for w in (weights.gaussian(), WEIGHTS)
    )
    assert cut < 0.005 and usual > 10 * cut


def test_what_the_mask_hides_does_not_bend_the_curve(decades):
    E = decades((60, 80))
    taken = camera.shoot(E, camera.times_around(E, 5, stops=2))
    images, valid = taken.images.copy(), np.ones(taken.images.shape, bool)
    images[1:3, :, :20], valid[1:3, :, :20] = 90, False
    for count in (4000, None):
        g = robertson.recover(taken.images[:, :, 20:], taken.times, samples=count)
        hidden = robertson.recover(images, taken.times, samples=count, valid=valid)
        assert np.allclose(hidden, g, atol=1e-9)


def test_all_pixels_of_colour_are_those_of_its_channels(decades):
    E = decades((40, 50))
    times = camera.times_around(E, 5, stops=1.5)
    gray = [
        camera.shoot(E, times, camera.Camera(response=name)).images for name in ("film", "gamma", "linear")
    ]
    g = robertson.recover(np.stack(gray, axis=-1), times, samples=None)
    for c, images in enumerate(gray):
        assert np.allclose(g[:, c], robertson.recover(images, times, samples=None), atol=1e-9)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"images": "one"}, "two exposures"),
        ({"times": [1, 1]}, "two exposures"),
        ({"images": "black"}, "two exposures"),
        ({"images": "white"}, "two exposures"),
        ({"smoothness": -1}, "smoothness that is finite and not negative"),
        ({"smoothness": np.nan}, "smoothness that is finite and not negative"),
    ],
)
def test_what_tells_nothing_is_refused(given, said):
    stack = np.tile(np.arange(256, dtype=np.uint8).reshape(16, 16), (2, 1, 1))
    stacks = {"one": stack[:1], "black": stack * 0, "white": stack * 0 + 255}
    knobs = {"images": stack, "times": [1, 2]} | given
    if isinstance(knobs["images"], str):
        knobs["images"] = stacks[knobs["images"]]
        knobs["times"] = knobs["times"][: len(knobs["images"])]
    with pytest.raises(ValueError, match=said):
        robertson.recover(**knobs)
