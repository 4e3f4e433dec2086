"""Robertson's response: the two weighted means and their alternation."""

import numpy as np
import pytest
from support import laws

from hdrlab.capture import camera, responses
from hdrlab.core import sampling, weights
from hdrlab.response import robertson

CURVES = sorted(responses.RESPONSES)
WEIGHTS = weights.cut(weights.gaussian(), below=0.02)


def samples(N=500, P=4, seed=0, top=255):
    """Return Z (N, P) of any levels and t (P,)."""
    rng = np.random.default_rng(seed)
    return rng.integers(0, top + 1, (N, P)), rng.uniform(0.1, 1, P)


# The equations


def test_irradiance_is_the_weighted_mean_of_the_slide():
    Z = np.array([[10, 100], [200, 250]])
    t = np.array([0.5, 1.0])
    f_inv = robertson.linear()
    w = weights.hat()
    for z, E in zip(Z, robertson.irradiance(Z, t, f_inv, w), strict=True):
        assert np.isclose(E, sum(w[z] * f_inv[z] * t) / sum(w[z] * t**2))


# Its steps


def test_each_state_keeps_the_gauge_and_says_how_much_it_changed():
    Z, t = samples(2000)
    states = list(robertson.recover_steps(Z, t, WEIGHTS, max_iterations=6, tolerance=0))
    assert len(states) == 7 and all(state.f_inv[128] == 1 for state in states)
    assert np.array_equal(states[0].f_inv, robertson.linear())
    for before, after in zip(states, states[1:], strict=False):
        assert after.change == np.abs(after.f_inv - before.f_inv).max()


def test_the_iterations_end_at_the_tolerance_or_at_their_number(seven_frames):
    _, taken = seven_frames("gamma")
    Z = sampling.by_rank(taken.images, 4000)
    for tolerance in (1e-2, 1e-3):
        changes = [
            s.change for s in robertson.recover_steps(Z, taken.times, WEIGHTS, tolerance=tolerance)
        ]
        assert changes[-1] < tolerance and all(change >= tolerance for change in changes[:-1])
    assert (
        len(list(robertson.recover_steps(Z, taken.times, WEIGHTS, tolerance=0, max_iterations=9)))
        == 10
    )


def test_level_0_and_levels_without_a_mean_or_beyond_the_cut_are_filled():
    means = np.arange(256.0)
    w = WEIGHTS
    means[[0, 3, 100, 250, 255]] = 7, np.nan, np.nan, 9, np.nan
    filled = robertson.fill(means, w)
    assert np.array_equal(filled[1:250], np.arange(1, 250)) and np.all(filled[250:] == 249)
    assert filled[0] == 0.25


def test_samples_in_one_exposure_raise_an_error():
    for Z, times in (([[0, 100]], [1, 2]), ([[100, 200]], [1, 1]), ([[100, 100]], [1, 2])):
        with pytest.raises(ValueError, match="well exposed in two photos"):
            next(robertson.recover_steps(np.array(Z), times, weights.hat()))


@pytest.mark.parametrize("name", ["film", "linear"])
def test_the_papers_scheme_recovers_the_response_of_frames_a_stop_apart(name, decades):
    E = decades((60, 80))
    taken = camera.shoot(E, camera.times_around(E, 7, stops=1), camera.Camera(response=name))
    g = robertson.recover(taken.images, taken.times, samples=500)
    assert laws.curve_error(g, responses.true_g(name)) < 0.01
