"""The bilateral filter, compared with the sum of its definition."""

import numpy as np
import pytest

from hdrlab.core.filters.bilateral import bilateral
from hdrlab.errors import InputError


def test_the_filter_is_the_mean_by_weights_in_space_and_range():
    v = np.random.default_rng(3).random((7, 9))
    sigma_s = 1.3
    sigma_r = 0.4
    y, x = np.indices(v.shape)
    mean = np.empty_like(v)
    k = np.empty_like(v)
    for row, column in np.ndindex(*v.shape):
        distance_squared = (y - row) ** 2 + (x - column) ** 2
        weight = np.exp(-distance_squared / (2 * sigma_s**2))
        weight *= np.exp(-((v - v[row, column]) ** 2) / (2 * sigma_r**2))
        weight[np.maximum(abs(y - row), abs(x - column)) > np.ceil(3 * sigma_s)] = 0
        k[row, column] = weight.sum()
        mean[row, column] = (weight * v).sum() / weight.sum()
    filtered = bilateral(v, sigma_s=sigma_s, sigma_r=sigma_r)
    assert np.allclose(filtered.mean, mean, atol=1e-6)
    assert np.allclose(filtered.k, k, rtol=1e-5)


def test_a_flat_signal_is_not_changed_and_k_falls_toward_the_edge():
    filtered = bilateral(np.full((20, 30), 3.5), sigma_s=2, sigma_r=0.1)
    assert np.allclose(filtered.mean, 3.5)
    assert filtered.k[10, 15] == pytest.approx(2 * np.pi * 2**2, rel=0.02)
    assert filtered.k[0, 0] < filtered.k[0, 15] < filtered.k[10, 15]


def test_a_level_added_to_the_signal_is_added_to_its_mean():
    v = np.random.default_rng(0).random((8, 8))
    there = bilateral(v + 5, sigma_s=2, sigma_r=0.3).mean
    assert np.allclose(there, bilateral(v, sigma_s=2, sigma_r=0.3).mean + 5, atol=1e-5)


@pytest.mark.parametrize("sigma", [0, -1, np.inf, np.nan])
@pytest.mark.parametrize("name", ["sigma_s", "sigma_r"])
def test_a_sigma_that_is_not_positive_and_finite_raises_an_error(name, sigma):
    sigmas = {"sigma_s": 1.0, "sigma_r": 1.0, name: sigma}
    with pytest.raises(ValueError, match=name):
        bilateral(np.zeros((4, 4)), **sigmas)


@pytest.mark.parametrize("v", [np.zeros(4), np.zeros((0, 4)), np.full((3, 3), np.nan)])
def test_a_signal_that_is_not_a_finite_plane_raises_an_error(v):
    with pytest.raises(InputError):
        bilateral(v, sigma_s=1, sigma_r=1)
