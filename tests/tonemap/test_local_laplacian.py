"""hdrlab.tonemap.local_laplacian: the remapping, and sampled remappings against one per coefficient."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from support import laws

from hdrlab.core.filters import pyramid
from hdrlab.core.steps import last
from hdrlab.tonemap import local_laplacian

KNOBS = {"sigma": 0.9, "alpha": 1.0, "beta": 0.2}


def by_definition(lL, **knobs):
    """Return the pyramid O_k, computed by remapping the image for each coefficient [Paris11 algorithm
    1].
    """
    G = pyramid.gaussian(lL, pyramid.depth(lL.shape, 2))
    answer = [np.zeros_like(level) for level in G[:-1]] + G[-1:]
    for k, level in enumerate(answer[:-1]):
        for y, x in np.ndindex(level.shape):
            r = local_laplacian.remap(lL, float(G[k][y, x]), **knobs)
            level[y, x] = pyramid.laplacian(r, len(G))[k][y, x]
    return answer


def test_sampling_approximates_the_definition_better_with_more_samples():
    lL = np.log(laws.scene((18, 25)))
    true = pyramid.collapse(by_definition(lL, **KNOBS))
    off = []
    for samples in (8, 32, 256):
        levels = last(local_laplacian.filter_steps(lL, **KNOBS, samples=samples)).levels
        off.append(np.abs(pyramid.collapse(levels) - true).max())
    assert off[0] > 3 * off[1] > 9 * off[2] and off[2] < 0.01


@pytest.mark.parametrize("samples", [2, 5, 24])
def test_alpha_1_and_beta_1_do_not_change_the_image(samples):
    lL = np.log(laws.scene((40, 61)))
    state = last(local_laplacian.filter_steps(lL, sigma=0.5, alpha=1.0, beta=1.0, samples=samples))
    assert np.allclose(pyramid.collapse(state.levels), lL, atol=1e-4)


@given(sigma=st.floats(0.1, 5), alpha=st.floats(0.2, 3), beta=st.floats(0, 1), g=st.floats(-9, 0))
def test_the_remapping_is_odd_about_g_and_goes_on_where_detail_ends(sigma, alpha, beta, g):
    d = np.array([0, sigma / 2, sigma, 1.001 * sigma, 3 * sigma])  # all above noise, or 0
    up = local_laplacian.remap(g + d, g, sigma=sigma, alpha=alpha, beta=beta) - g
    down = local_laplacian.remap(g - d, g, sigma=sigma, alpha=alpha, beta=beta) - g
    assert np.allclose(up, -down) and up[0] == 0
    assert np.allclose(up[[1, 2, 4]], [sigma / 2**alpha, sigma, sigma + 2 * beta * sigma])
    assert up[3] == pytest.approx(sigma, rel=0.0011)


@pytest.mark.parametrize("alpha", [0.25, 0.5, 0.75])
def test_differences_below_one_percent_stay_as_they_are_and_larger_ones_have_the_power(alpha):
    noise = np.array([-0.01, -0.004, 0.0, 0.002, 0.01])
    r = local_laplacian.remap(noise - 3, -3.0, sigma=0.9, alpha=alpha, beta=0.3)
    assert np.allclose(r + 3, noise)
    details = np.array([0.02, 0.1, 0.5])
    r = local_laplacian.remap(details - 3, -3.0, sigma=0.9, alpha=alpha, beta=0.3)
    assert np.allclose(r + 3, 0.9 * (details / 0.9) ** alpha)


def test_the_step_from_noise_to_details_is_smooth_and_rises():
    d = np.linspace(0, 0.03, 301)
    r = local_laplacian.remap(d, 0.0, sigma=0.9, alpha=0.5, beta=0.0)
    assert np.all(np.diff(r) > 0)
    assert np.abs(np.diff(r)).max() < 0.003


def test_noise_of_half_a_percent_is_hardly_amplified():
    noise = np.random.default_rng(0).normal(0, 0.005, (64, 64))
    L = np.exp(noise)
    plain = np.log(local_laplacian.tonemap(L, alpha=1.0, samples=60))
    raised = np.log(local_laplacian.tonemap(L, alpha=0.5, samples=60))
    assert raised.std() < 4 * plain.std()  # ten times without the guard


def test_by_default_the_samples_are_half_a_sigma_apart_for_any_range():
    L = np.geomspace(1e-6, 1, 64 * 64).reshape(64, 64)
    fine = local_laplacian.tonemap(L, samples=400)
    coarse = np.abs(local_laplacian.tonemap(L, samples=16) - fine).max()
    assert np.abs(local_laplacian.tonemap(L) - fine).max() < coarse / 2


def test_each_sample_is_a_step_and_a_later_one_leaves_it_as_it_was():
    lL = np.log(laws.scene((40, 50)))
    steps = list(local_laplacian.filter_steps(lL, **KNOBS, samples=6))
    assert np.allclose([step.g for step in steps], np.linspace(lL.min(), lL.max(), 6))
    assert all(np.array_equal(step.r, local_laplacian.remap(lL, step.g, **KNOBS)) for step in steps)
    first = next(local_laplacian.filter_steps(lL, **KNOBS, samples=6))
    assert all(map(np.array_equal, first.levels, steps[0].levels))


def test_a_smaller_beta_shows_more_of_the_dark_and_a_smaller_alpha_more_detail():
    L = laws.scene((96, 128))
    dark = [
        np.median(local_laplacian.tonemap(L, beta=beta)[L < np.median(L)]) for beta in (1, 0.4, 0)
    ]
    assert dark[0] < dark[1] < dark[2]
    lLd = [np.log(local_laplacian.tonemap(L, alpha=alpha)) for alpha in (2, 1, 0.6)]
    fine = [np.abs(pyramid.laplacian(values, 3)[0]).mean() for values in lLd]
    assert fine[0] < fine[1] < fine[2]


def test_there_is_no_halo_beside_a_step():
    """With a blurred base, the dark side gets darker at the edge; here it gets brighter."""
    L = np.where(np.arange(128) < 64, 1.0, 1000.0) * np.ones((128, 1))
    row = np.log(local_laplacian.tonemap(L)[64])
    assert np.diff(row).min() > -0.02 and np.ptp(row) < 0.5 * np.log(1000)
    assert row[64] - row[63] > 0.35 * np.ptp(row)


def test_more_than_the_display_shows_is_compressed_to_its_contrast():
    Ld = local_laplacian.tonemap(laws.scene(), beta=1)
    cut = local_laplacian.CLIPPED_FRACTION
    black, white = np.log(np.quantile(Ld, [cut, 1 - cut]))
    assert white == pytest.approx(0, abs=0.01)
    assert black == pytest.approx(-local_laplacian.DISPLAY_CONTRAST, abs=0.05)


def test_a_uniform_scene_becomes_white_and_a_black_one_black():
    assert np.all(local_laplacian.tonemap(np.full((20, 30), 3.7)) == 1)
    assert not local_laplacian.tonemap(np.zeros((20, 30))).any()


@pytest.mark.parametrize(
    "knobs",
    [{"sigma": 0}, {"alpha": 0}, {"alpha": np.inf}, {"beta": -0.1}, {"beta": 1.1}, {"samples": 1}],
)
def test_parameters_out_of_range_raise_an_error(knobs):
    with pytest.raises(ValueError, match="sigma"):
        local_laplacian.tonemap(np.ones((3, 3)), **knobs)
