"""Responses from histograms: transfer functions, both models, and the comparison of Cerman and Hlavac."""

import numpy as np
import pytest
from support import laws

from hdrlab.capture import camera, responses
from hdrlab.core import transfer, weights
from hdrlab.errors import InputError
from hdrlab.response import grossberg

CURVES = sorted(responses.RESPONSES)
MODELS = {"table": grossberg.recover, "polynomial": grossberg.recover_polynomial}


def test_the_comparagram_counts_pairs_of_levels():
    A = np.array([[1, 1], [2, 3]], np.uint8)
    B = np.array([[5, 5], [5, 250]], np.uint8)
    J = grossberg.comparagram(A, B)
    assert J.sum() == 4 and J[1, 5] == 2 and J[2, 5] == 1 and J[3, 250] == 1


def test_the_transfer_is_the_ridge_of_the_comparagram(seven_frames):
    _, taken = seven_frames("film")
    A, B = taken.images[3:5]
    J = grossberg.comparagram(A, B)
    T = transfer.brightness_transfer(J.sum(axis=1), J.sum(axis=0))
    m = np.flatnonzero(np.isfinite(T) & (J.sum(axis=1) > 30) & (T < 245))
    ridge = np.array([np.median(np.repeat(np.arange(256), J[level])) for level in m])
    assert len(m) > 50 and np.median(np.abs(ridge - T[m])) < 1


# The two models


def test_the_equations_hold_on_the_true_curve(seven_frames):
    _, taken = seven_frames("film")
    g = responses.true_g("film")
    w = weights.cut(weights.hat(), below=0.05)
    equations = grossberg.build_equations(transfer.histograms(taken.images)[0], taken.times, w)
    miss = np.interp(equations.T, np.arange(256), g) - g[equations.m] + np.log(equations.R)
    assert np.count_nonzero(equations.weight) > 300
    assert np.sqrt(np.average(miss**2, weights=equations.weight**2)) < 0.02


def test_fractional_levels_are_interpolated():
    g = np.random.default_rng(0).normal(size=256)
    T = np.array([0.0, 3.25, 254.5, 255.0])
    assert np.allclose(grossberg.interpolate_levels(T) @ g, np.interp(T, np.arange(256), g))


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("name", CURVES)
def test_seven_frames_give_the_response_to_one_percent(name, model, seven_frames):
    _, taken = seven_frames(name)
    g = MODELS[model](taken.images, taken.times)
    assert laws.curve_error(g, responses.true_g(name)) < (0.003 if model == "table" else 0.01)


@pytest.mark.parametrize("model", MODELS)
def test_the_result_does_not_depend_on_the_alignment_of_frames(model, seven_frames):
    _, taken = seven_frames("film")
    turned = np.stack([np.rot90(image, 2 * (j % 2)) for j, image in enumerate(taken.images)])
    g = MODELS[model](taken.images, taken.times)
    assert np.array_equal(MODELS[model](turned, taken.times), g)


@pytest.mark.parametrize("law", laws.RECOVERY, ids=lambda law: law.__name__)
@pytest.mark.parametrize("name", CURVES)
def test_the_polynomial_obeys_the_laws_too(name, law):
    law(grossberg.recover_polynomial, name)


def test_masked_pixels_do_not_change_the_curve(decades):
    E = decades((60, 80))
    taken = camera.shoot(E, camera.times_around(E, 5, stops=2))
    images = taken.images.copy()
    valid = np.ones(taken.images.shape, bool)
    images[1:3, :, :20] = 90
    valid[1:3, :, :20] = False
    g = grossberg.recover(taken.images[:, :, 20:], taken.times)
    assert np.allclose(grossberg.recover(images, taken.times, valid=valid), g, atol=1e-12)


STACK = np.tile(np.arange(256, dtype=np.uint8).reshape(16, 16), (2, 1, 1))


@pytest.mark.parametrize(
    ("images", "times", "knobs"),
    [
        (STACK[:1], [1], {}),
        (STACK, [1, 1], {}),
        (STACK * 0, [1, 2], {}),
        (STACK * 0 + 255, [1, 2], {}),
        (STACK, [1, 2], {"smoothness": 0}),
    ],
)
def test_brackets_without_two_exposures_raise_an_error(images, times, knobs):
    with pytest.raises(InputError):
        grossberg.recover(images, times, **knobs)


def test_a_polynomial_of_order_0_raises_an_error():
    with pytest.raises(ValueError, match="order"):
        grossberg.recover_polynomial(STACK, [1, 2], order=0)


# The published comparison


@pytest.fixture(scope="module")
def figures():
    papers = pytest.importorskip("benchmarks.papers.cerman")
    return [papers.figure3(rng=seed) for seed in range(3)]


def test_on_clean_photographs_all_methods_are_close_to_the_truth(figures):
    assert max(max(figure.clean.values()) for figure in figures) < 0.15


def test_noise_makes_pixels_and_polynomials_fail(figures):
    for figure in figures:
        assert figure.noisy["Debevec, pixels"] > 1.5
        assert figure.noisy["polynomial, pixels"] > 5 and figure.noisy["polynomial, histograms"] > 5


def test_cut_weights_rescue_debevec_but_not_the_polynomial_of_pixels(figures):
    for figure in figures:
        assert figure.cut["Debevec, pixels"] <= 0.5 and figure.cut["polynomial, pixels"] > 5


def test_from_histograms_with_the_cut_no_method_fails(figures):
    for figure in figures:
        assert figure.cut["Debevec, histograms"] <= 0.1
        assert figure.cut["polynomial, histograms"] <= 0.2


def test_a_polynomial_of_the_cameras_own_order_fits(figures):
    assert max(max(figure.known.values()) for figure in figures) < 0.1
