"""Which pixels to trust: averages, flat patches, and the circle without vignetting."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from hdrlab.response import selection

INNER = (slice(2, -2), slice(2, -2))


def noise(t, shape=(300, 300), sigma=0.01, seed=0):
    """Return t frames of a uniform surface."""
    return np.random.default_rng(seed).normal(0.5, sigma, (t, *shape))


def test_the_published_threshold_is_36_4():
    assert round(selection.threshold(25, psi=0.05), 1) == 36.4


@given(s=st.integers(2, 100), psi=st.floats(0.01, 0.5))
def test_the_threshold_for_well_estimated_noise_equals_that_for_known_noise(s, psi):
    exact = selection.threshold(s, psi=psi)
    assert np.isclose(selection.threshold(s, psi=psi, estimated=1e9), exact, rtol=1e-5)
    assert selection.threshold(s, psi=0.05, estimated=10) > selection.threshold(s, psi=0.05)


def test_the_temporal_average_is_mean_and_unbiased_variance():
    A = noise(7, (4, 5))
    mean, variance, t = selection.temporal_average(A)
    assert t == 7
    assert np.allclose(mean, A.mean(axis=0))
    assert np.allclose(variance, A.var(axis=0, ddof=1))
    assert np.all(selection.temporal_average(A[:1], sigma=0.02).variance == 0.02**2)


def test_the_spatial_average_is_that_of_the_patch():
    A = noise(1, (9, 9))[0] + 1000  # far from 0, where squares would drown the differences
    mean, variance = selection.spatial_average(A, size=5)
    patch = A[2:7, 1:6]
    assert np.isclose(mean[4, 3], patch.mean())
    assert np.isclose(variance[4, 3], patch.var(), rtol=1e-6)


@pytest.mark.parametrize("t", [1, 2, 100])
@pytest.mark.parametrize("psi", [0.05, 0.2])
def test_the_test_rejects_the_fraction_psi_of_flat_patches(t, psi):
    kept = selection.flat(noise(t), psi=psi)[INNER].mean()
    assert abs(kept - (1 - psi)) < 0.01


def test_equation_12_read_literally_would_accept_an_edge_in_the_average():
    """Read literally, eq. 12 accepts an edge of one sigma; the corrected test rejects it."""
    A = noise(100, (60, 60))
    A[:, :, 30:] += 0.01
    mean, variance, _ = selection.temporal_average(A)
    _, spread = selection.spatial_average(mean)
    edge = (slice(2, -2), slice(29, 31))
    assert (25 * spread <= selection.threshold() * variance)[edge].all()
    assert not selection.flat(A)[edge].any()


def test_edges_and_the_border_are_not_flat():
    A = np.full((1, 40, 40), 0.3)
    A[:, :, 20:] = 0.6
    result = selection.flat(A)
    expected = np.zeros((40, 40), bool)
    expected[INNER] = True
    expected[:, 18:22] = False
    assert np.array_equal(result, expected)


def test_quantisation_to_256_levels_does_not_spoil_the_test():
    A = np.round(255 * noise(1)) / 255
    assert abs(selection.flat(A)[INNER].mean() - 0.95) < 0.02


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: selection.flat(np.zeros((4, 4))), r"\(t, H, W\)"),
        (lambda: selection.flat(np.full((1, 4, 4), np.nan)), "finite frames"),
        (lambda: selection.flat(np.zeros((1, 9, 9)), size=1), "patch of 2 x 2"),
        (lambda: selection.flat(np.zeros((1, 9, 9)), sigma=0), "noise above 0"),
        (lambda: selection.threshold(1), "s of at least 2"),
        (lambda: selection.threshold(25, psi=1), "psi"),
        (
            lambda: selection.circle(np.zeros((9, 9), np.uint8), np.zeros((9, 9), np.uint8)),
            "neither frame",
        ),
    ],
)
def test_invalid_arguments_raise_an_error(call, message):
    with pytest.raises(ValueError, match=message):
        call()


# Vignetting


def apertures(edge, shape=(240, 320), seed=0):
    """Return two frames, of which the second loses light beyond a radius."""
    rng = np.random.default_rng(seed)
    E = rng.uniform(10, 240, shape)
    left = 1 - 0.4 * np.clip((selection.radius(shape) - edge) / 100, 0, 1)
    return [
        np.round(light + rng.normal(0, 0.7, shape)).clip(0, 255).astype(np.uint8)
        for light in (E / 2, E * left)
    ]


def test_the_radius_is_measured_from_the_middle():
    r = selection.radius((3, 5))
    assert r[1, 2] == 0 and r[1, 0] == 2 and np.isclose(r[0, 0], np.sqrt(5))


@pytest.mark.parametrize("edge", [70, 110, 150])
@pytest.mark.parametrize("seed", range(3))
def test_the_circle_ends_where_vignetting_begins(edge, seed):
    assert edge - 5 < selection.circle(*apertures(edge, seed=seed)) < edge + 15


@pytest.mark.parametrize("seed", range(5))
def test_without_vignetting_the_circle_covers_the_whole_image(seed):
    assert selection.circle(*apertures(1e9, seed=seed)) == selection.radius((240, 320)).max()


def test_frames_may_have_a_single_pixel():
    average = selection.temporal_average(np.array([[[0.2]], [[0.4]]]))
    assert average.mean == pytest.approx(np.array([[0.3]]))
    assert average.variance == pytest.approx(np.array([[0.02]]))


def test_the_smallest_patch_has_two_by_two_pixels():
    assert 0.8 < selection.flat(noise(3), size=2)[INNER].mean() <= 1
    with pytest.raises(ValueError, match="2 x 2"):
        selection.flat(noise(3), size=1)
