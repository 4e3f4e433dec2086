"""Exposure ratios of a linear camera, estimated from histograms."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from hdrlab.capture import camera
from hdrlab.errors import InputError
from hdrlab.io.radiance import read_radiance
from hdrlab.radiance import ratios

SCHEMES = sorted(ratios.SCHEMES)


def log_normal(seed=0, shape=(512, 512), spread=1.5):
    """Return a scene with normally distributed ln E, of which the brightest thousandth is clipped at 1."""
    E = np.exp(np.random.default_rng(seed).normal(0, spread, shape))
    return np.minimum(E / np.quantile(E, 0.999), 1).astype(np.float32)


def pair(E, truth, seed=0, **knobs):
    """Return two photos of a linear camera whose noise is the same at all levels."""
    return camera.shoot(
        E, [1, truth], camera.Camera(response="linear", **{"gray_noise": 1.0} | knobs), rng=seed
    ).images


# The equations


@given(k=st.floats(1.2, 8), seed=st.integers(0, 99))
def test_exact_equations_give_the_ratio_at_once(k, seed):
    rng = np.random.default_rng(seed)
    x = rng.uniform(16, 200, 40)
    equations = ratios.Equations(x, k * x, rng.uniform(0.1, 1, 40))
    states = list(ratios.ratio_steps(equations))
    assert np.isclose(states[0].k, k) and np.isclose(states[-1].k, k)


def test_the_solution_is_the_least_squares_solution():
    rng = np.random.default_rng(0)
    equations = ratios.Equations(
        rng.uniform(1, 9, 30), rng.uniform(1, 9, 30), rng.uniform(0, 1, 30)
    )
    k = np.linalg.lstsq(
        (equations.v * equations.x)[:, None], equations.v * equations.y, rcond=None
    )[0][0]
    assert np.isclose(ratios.solve_ratio(equations, np.ones(30, bool)), k)


def test_each_iteration_keeps_the_equations_below_the_error_limit_of_the_last():
    rng = np.random.default_rng(1)
    x = rng.uniform(16, 60, 200)
    y = 4 * x + rng.normal(0, 0.5, 200)
    y[:12] += 60
    equations = ratios.Equations(x, y, np.ones(200))
    states = list(ratios.ratio_steps(equations, limit=3.0))
    for before, after in zip(states, states[1:], strict=False):
        errors = (y - before.k * x) ** 2
        assert np.array_equal(after.used, errors <= 3 * errors[before.used].mean())
    assert not states[-1].used[:12].any() and abs(states[-1].k - 4) < 0.01 < abs(states[0].k - 4)
    assert abs(states[-1].k - states[-2].k) < 1e-6


def test_the_papers_equations_are_biased_and_the_corrected_ones_are_not():
    light = (np.arange(400_000) + 0.5) / 400_000 * 240
    h = [np.bincount(np.floor(light * s + 0.5).astype(int), minlength=256) for s in (0.25, 1)]
    paper = ratios.collect_equations(*h, "paper")
    corrected = ratios.collect_equations(*h, "mid-step")
    assert np.isclose(np.median(paper.y - 4 * paper.x), 1.5, atol=0.01)
    whole = corrected.y < 236  # the light ends at 240, within a step of the darker frame
    assert np.abs(corrected.y - 4 * corrected.x)[whole].max() < 0.02


# Photographs


@pytest.mark.parametrize("seed", range(20))
def test_the_darkest_pair_of_the_paper(seed):
    images = pair(log_normal(seed), 4, seed)
    assert abs(ratios.estimate_ratio(*images, scheme="paper") - 4) < 0.05
    assert abs(ratios.estimate_ratio(*images) - 4) < 0.01


@pytest.mark.papers
@pytest.mark.parametrize("name", ["city", "esplanade", "hall", "lobby", "studio", "venice"])
def test_the_darkest_pair_of_real_radiance(name, shared):
    G = read_radiance(shared("hdri_cc0") / f"{name}.hdr")[..., 1]
    G = np.minimum(G / np.quantile(G, 0.999), 1)
    for seed in range(20):
        assert abs(ratios.estimate_ratio(*pair(G, 4, seed)) - 4) < 0.02


@pytest.mark.parametrize("truth", [1.25, 1.6, 2.7, 5.3])
def test_other_ratios_are_found_to_a_quarter_of_a_percent(truth):
    assert abs(ratios.estimate_ratio(*pair(log_normal(), truth)) / truth - 1) < 0.0025


def test_exposure_times_are_recovered_without_alignment():
    E = log_normal(3)
    taken = camera.shoot(E, [1, 2, 5, 15], camera.Camera(response="linear", gray_noise=1.0), rng=3)
    images = np.stack([np.rot90(image, 2 * (j % 2)) for j, image in enumerate(taken.images)])
    assert np.allclose(np.cumprod(ratios.estimate_ratios(images)), [2, 5, 15], rtol=0.01)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_swapping_the_frames_inverts_the_ratio(scheme):
    images = pair(log_normal(), 3)
    assert np.isclose(
        ratios.estimate_ratio(*images[::-1], scheme=scheme),
        1 / ratios.estimate_ratio(*images, scheme=scheme),
    )


def test_16_bit_photos_work():
    images = pair(log_normal(), 4, bits=16, gray_noise=64.0)
    assert abs(ratios.estimate_ratio(*images) - 4) < 0.01


def test_all_channels_have_one_ratio():
    rng = np.random.default_rng(0)
    E = log_normal()[..., None] * rng.uniform(0.3, 1, (1, 1, 3))
    assert abs(ratios.estimate_ratio(*pair(E.astype(np.float32), 4)) - 4) < 0.01


def test_masked_pixels_do_not_change_the_ratio():
    images = pair(log_normal(), 4)
    spoiled = images.copy()
    valid = np.ones(images.shape, bool)
    spoiled[1, :, :100] = 90
    valid[1, :, :100] = False
    assert ratios.estimate_ratios(spoiled, valid=valid) == ratios.estimate_ratios(
        images[:, :, 100:]
    )


# What is refused


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("truth", [200, 5000])
def test_frames_that_do_not_overlap_in_brightness_raise_an_error(scheme, truth):
    with pytest.raises(ValueError, match="frames that overlap in brightness"):
        ratios.estimate_ratio(*pair(log_normal(), truth, gray_noise=0.0), scheme=scheme)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("level", [0, 100, 255])
def test_constant_frames_raise_an_error(scheme, level):
    with pytest.raises(InputError):
        ratios.estimate_ratios(np.full((2, 8, 8), level, np.uint8), scheme=scheme)


@pytest.mark.parametrize(
    ("images", "knobs"),
    [
        (np.zeros((1, 4, 4), np.uint8), {}),
        (np.zeros((2, 4, 4)), {}),
        (np.zeros((2, 4, 4), np.uint8), {"scheme": "best"}),
        (np.zeros((2, 4, 4), np.uint8), {"valid": np.zeros((2, 4, 4), bool)}),
    ],
)
def test_invalid_arguments_raise_an_error(images, knobs):
    with pytest.raises(InputError):
        ratios.estimate_ratios(images, **knobs)


def test_levels_without_pixels_give_no_equation():
    h = np.zeros((2, 256), int)
    h[0, 20:50] = 10
    h[1, 80:200:4] = 10
    equations = ratios.collect_equations(*h)
    assert equations.x[:30].tolist() == list(range(20, 50))
    assert equations.y[30:].tolist() == list(range(80, 200, 4))
    assert np.allclose(equations.y, 4 * equations.x)


def test_iterations_end_when_the_ratio_no_longer_changes():
    x = np.linspace(1, 100, 200)
    exact = ratios.Equations(x, 3 * x, np.ones_like(x))
    steps = list(ratios.ratio_steps(exact))
    assert len(steps) == 2 and steps[-1].k == pytest.approx(3)


def test_the_papers_scheme_uses_every_level_but_the_first_and_the_middle_scheme_no_dark_ones():
    h = np.ones(256)
    least = {
        name: (equations.x.min(), equations.y.min())
        for name in ratios.SCHEMES
        for equations in [ratios.collect_equations(h, h, name)]
    }
    assert least["paper"] == pytest.approx((1, 1), abs=0.51) and least["mid-step"][1] >= 64
