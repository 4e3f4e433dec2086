"""The space of responses: components, projection, few samples, files of measured curves."""

import numpy as np
import pytest
from support.laws import simulate_bracket as shots

from hdrlab import scenes
from hdrlab.capture import camera, responses
from hdrlab.core import sampling
from hdrlab.core.metrics import response_rmse
from hdrlab.errors import InputError
from hdrlab.fast import debevec
from hdrlab.response import families, space

X = np.linspace(0, 1, 256)
POWERS = np.stack([X**gamma for gamma in np.arange(0.3, 1.01, 0.05)])


@pytest.fixture(scope="module")
def papers():
    return pytest.importorskip("benchmarks.papers.space")


@pytest.fixture(scope="module")
def measured(measured_curves):
    return measured_curves


@pytest.fixture(scope="module")
def curves(measured):
    exposure, brightness = measured
    return np.stack(
        [
            np.interp(np.linspace(0, 1, 1024), x, m)
            for x, m in zip(exposure, brightness, strict=True)
        ]
    )


def test_components_are_orthonormal_and_ordered_by_spread():
    fitted = space.fit_space(POWERS, 5)
    assert np.allclose(fitted.H @ fitted.H.T, np.eye(5), atol=1e-12)
    assert np.all(np.diff(fitted.sd) < 0)


def test_reconstruction_is_exact_with_as_many_components_as_the_curves_span():
    fitted = space.fit_space(POWERS, len(POWERS) - 1)
    assert np.allclose(space.reconstruct(space.project(POWERS, fitted), fitted), POWERS, atol=1e-12)


def test_the_spread_is_that_of_the_coefficients():
    fitted = space.fit_space(POWERS, 4)
    assert np.allclose(space.project(POWERS, fitted).std(axis=0), fitted.sd)


def test_noiseless_samples_determine_the_curve_exactly():
    fitted = space.fit_space(POWERS, 3)
    curve = space.reconstruct([0.4, -0.2, 0.05], fitted)
    at = np.linspace(0.05, 0.95, 9)
    again = space.fit_samples(at, np.interp(at, X, curve), fitted, noise=1e-9)
    assert np.allclose(again, curve, atol=1e-6)


def test_with_infinite_noise_the_most_likely_curve_is_the_mean():
    fitted = space.fit_space(POWERS, 3)
    assert np.allclose(space.fit_samples([0.5], [0.9], fitted, noise=1e6), fitted.mean, atol=1e-9)


def test_every_formula_rises_from_zero_to_one():
    curves = families.tabulate()
    assert np.all(np.diff(curves, axis=1) > 0)
    assert np.allclose(curves[:, -1], 1)
    assert np.all(curves[:, 0] > 0)


@pytest.mark.parametrize("gamma", [1.6, 2.4])
def test_the_linear_toe_is_tangent_to_the_curve(gamma):
    at = 0.05
    step = 1e-6
    M = np.array([at - step, at, at + step])
    below, here, above = families.toe(M, gamma, at)
    assert abs((above - here) - (here - below)) < 1e-4 * (here - below)


@pytest.mark.parametrize("name", sorted(responses.RESPONSES))
def test_the_default_space_contains_every_simulated_response(name):
    basis = space.default_space()
    g = responses.true_g(name)
    apart = np.exp(space.reconstruct(space.project(g, basis), basis)) - np.exp(g)
    assert np.abs(apart).max() < 0.01 * np.exp(g).max()


def test_the_inverse_of_a_measured_curve_is_its_g():
    x = np.linspace(0, 1, 4096) ** 3
    g = families.invert_curves(x, x ** (1 / 2.2))[0]
    assert np.allclose(g[2:], responses.true_g("gamma")[2:], atol=1e-3)


def test_recover_with_your_own_basis_returns_a_curve_in_its_span():
    basis = space.fit_space(
        families.to_log(np.stack([families.power(X + 1e-3, k) for k in (1, 2, 3)])), 2
    )
    E = np.geomspace(0.01, 1, 2400).reshape(40, 60)
    taken = camera.shoot(E, [0.25, 0.5, 1.0], camera.Camera(response="gamma"))
    g = space.recover(taken.images, taken.times, basis=basis)
    assert abs(g[200] - 2.2 * np.log(200 / 128)) < 0.03


def test_invalid_arguments_raise_an_error():
    for call in (
        lambda: space.fit_space(POWERS, 0),
        lambda: space.fit_space(POWERS, 99),
        lambda: space.fit_space(POWERS * np.nan, 2),
        lambda: space.project(np.ones(5), space.default_space()),
        lambda: space.truncate(space.default_space(), 13),
        lambda: space.fit_samples([0.5, 0.6], [0.5], space.default_space()),
        lambda: space.fit_samples([1.5], [0.5], space.default_space()),
        lambda: space.fit_samples([0.5], [0.5], space.default_space(), noise=0),
        lambda: families.invert_curves(X[None], X[None, ::-1]),
        lambda: space.recover(
            np.zeros((2, 4, 4), np.uint8), [1, 2], basis=space.fit_space(POWERS[:, :99], 2)
        ),
        lambda: space.recover(np.zeros((2, 4, 4), np.uint8), [1, 2]),
        lambda: space.recover(np.full((2, 4, 4), 100, np.uint8), [1, 1]),
    ):
        with pytest.raises(InputError):
            call()


# Measured curves


def test_the_published_components_are_orthonormal_and_of_three_digit_exponents(shared, papers):
    emor = papers.read_emor(shared("crf_curves") / "emor.txt")
    assert emor.H.shape == (25, 1024) and emor.mean.shape == (1024,)
    assert np.allclose(emor.H @ emor.H.T, np.eye(25), atol=1e-6)


def test_the_published_components_have_the_published_residuals(shared, papers, curves):
    left = papers.projection(curves, papers.read_emor(shared("crf_curves") / "emor.txt"))
    assert left[3] < 0.00575 and left[5] < 0.00235 and left[11] < 0.00055


def test_components_fitted_to_201_curves_have_residuals_like_the_published_ones(papers, curves):
    left = papers.projection(curves, space.fit_space(curves, 11))
    assert left[3] < 0.0057 and left[5] < 0.00231 and left[11] < 0.00053


def test_five_gray_patches_and_the_prior_find_a_response_to_a_percent(papers, curves):
    # 51 of the 201, each by a prior of the other 50
    errors = papers.five_samples(curves[::4], near=0.01)
    assert errors.mean() < 0.01


def test_the_inverses_of_measured_curves_are_finite_and_rise(measured):
    g = families.invert_curves(*measured)
    assert g.shape == (201, 256) and np.all(np.isfinite(g)) and np.all(np.diff(g, axis=1) >= -1e-12)


@pytest.mark.papers
def test_the_response_of_measured_cameras_is_recovered_with_the_formulas_as_prior(measured):
    """51 of the 201 curves, none of them among the formulas, in 8 bits with noise.

    The typical error is 0.4 %.
    """
    errors = []
    for g, x, m in zip(
        families.invert_curves(*measured)[::4], *(curves[::4] for curves in measured), strict=True
    ):
        taken = shots(lambda X, x=x, m=m: np.interp(X, x, m), frames=5)
        errors.append(response_rmse(space.recover(taken.images, taken.times), g)[0])
    assert np.median(errors) < 0.6 and np.percentile(errors, 95) < 2 and max(errors) < 3


def test_notebook_09_names_the_better_method_for_two_noisy_photos():
    f = responses.RESPONSES["film"].f
    s = responses.RESPONSES["srgb"].f

    def mix_curves(X):
        return (f(X) + s(X)) / 2

    def draw_wave(X):
        return X ** (1 / 2.2) + 0.03 * np.sin(6 * np.pi * X ** (1 / 2.2))

    cameras = {"film": "film", "srgb": "srgb", "mix": mix_curves, "wig": draw_wave}
    sensor = {"sensitivity": 1 / 16, "full_well": 20_000, "read_noise": 5, "gray_noise": 2}
    workshop = scenes.workshop((128, 192))[..., 1]
    times = camera.times_around(workshop, 2, stops=2, sensitivity=1 / 16)
    gsolve = {}
    ours = {}
    for name, response in cameras.items():
        taken = camera.shoot(workshop, times, camera.Camera(response=response, **sensor), rng=4)
        Z = taken.images
        true = responses.true_g(response)
        for count in (100, 4000):
            knobs = {"samples": count, "choose": sampling.by_grid}
            by_gsolve = debevec.recover(Z, times, **knobs)
            by_space = space.recover(Z, times, noise=0.05, **knobs)
            gsolve[name, count] = response_rmse(by_gsolve, true)[0]
            ours[name, count] = response_rmse(by_space, true)[0]
    for name in ("film", "srgb"):  # better, with half to two thirds of the error
        assert 0.45 < ours[name, 100] / gsolve[name, 100] < 0.7
    assert ours["mix", 100] > gsolve["mix", 100] and ours["mix", 4000] < gsolve["mix", 4000]
    assert min(ours["wig", n] / gsolve["wig", n] for n in (100, 4000)) > 5
    assert gsolve["film", 4000] > gsolve["film", 100]
    assert all(gsolve[name, 4000] < gsolve[name, 100] for name in ("srgb", "wig"))


def test_noise_of_0_raises_an_error():
    with pytest.raises(ValueError, match="noise > 0"):
        space.recover(np.zeros((2, 4, 4), np.uint8), [1, 2], noise=0)
