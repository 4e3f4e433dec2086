"""hdrlab.fast.bilateral: the grid against the definition, and the definition against scikit-image."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from scipy.ndimage import gaussian_filter
from skimage.restoration import denoise_bilateral

from hdrlab.core.colour import luminance
from hdrlab.core.filters.bilateral import bilateral as by_definition
from hdrlab.fast.bilateral import bilateral as fast_bilateral
from hdrlab.io.maps import rgbe


def room(shape=(70, 90), seed=0):
    """Return log10 luminance of about five decades: soft light, two hard edges, texture."""
    rng = np.random.default_rng(seed)
    y, x = np.indices(shape) / max(shape)
    light = 1.5 * np.exp(-8 * ((x - 0.6) ** 2 + (y - 0.3) ** 2)) + 2 * (x > 0.8) - 1.5 * (y > 0.5)
    return (light + 0.1 * rng.standard_normal(shape)).astype(np.float32)


def rms(a, b):
    return float(np.sqrt(np.mean((a - b) ** 2)))


def spatial_weights(win_size, sigma, *, dtype=float):
    """Return g over the window, as scikit-image's table of it should be.

    Its own runs from -n // 2, one row and column too many for an odd n, and is then read with rows
    of n: a Gaussian sheared over the window.
    """
    far = np.arange(win_size) - win_size // 2
    return np.exp(-(far[:, None] ** 2 + far**2) / (2 * sigma**2)).astype(dtype).ravel()


@pytest.mark.parametrize(("sigma_s", "sigma_r"), [(1.5, 0.2), (3, 0.4), (5, 1.0)])
def test_the_lesson_agrees_with_scikit_image_within_a_thousandth(sigma_s, sigma_r, monkeypatch):
    """Away from the edge, beyond which scikit-image takes a constant for picture."""
    monkeypatch.setattr("skimage.restoration._denoise._compute_spatial_lut", spatial_weights)
    v = room().astype(np.float64)
    r = int(np.ceil(3 * sigma_s))
    theirs = denoise_bilateral(v - v.min(), 2 * r + 1, sigma_r, sigma_s, bins=100_000) + v.min()
    inside = (slice(r, -r), slice(r, -r))
    assert (
        np.abs(by_definition(v, sigma_s=sigma_s, sigma_r=sigma_r).mean - theirs)[inside].max()
        < 1e-3
    )


@pytest.mark.parametrize("sigma_s", [1, 2.9, 4, 6, 8.5, 12])
def test_the_grid_agrees_with_the_definition_within_a_hundredth_of_sigma_r(sigma_s):
    """Root mean square; 0.004 decades for the sigma_r of tone mapping."""
    v = room()
    fast = fast_bilateral(v, sigma_s=sigma_s, sigma_r=0.4)
    exact = by_definition(v, sigma_s=sigma_s, sigma_r=0.4)
    assert rms(fast.mean, exact.mean) < 0.004
    assert np.abs(fast.mean - exact.mean).max() < 0.1
    assert np.median(np.abs(fast.k / exact.k - 1)) < 0.1


@pytest.mark.parametrize("name", ["memorial", "lobby"])
def test_on_photographs_the_base_is_within_five_thousandths_of_a_decade(shared, name):
    path = (
        shared("memorial") / "memorial.hdr"
        if name == "memorial"
        else shared("hdri_cc0") / f"{name}.hdr"
    )
    L = luminance(rgbe.read(path))[::4, ::4]
    v = np.log10(np.maximum(L, L[L > 0].min()))
    for sigma_s in (3, 6):
        fast = fast_bilateral(v, sigma_s=sigma_s, sigma_r=0.4)
        exact = by_definition(v, sigma_s=sigma_s, sigma_r=0.4)
        assert rms(fast.mean, exact.mean) < 0.005


@pytest.mark.parametrize("method", [by_definition, fast_bilateral])
def test_a_constant_is_not_changed_and_k_counts_all_neighbours(method):
    filtered = method(np.full((61, 73), 3.7), sigma_s=5, sigma_r=0.4)
    assert np.allclose(filtered.mean, 3.7, atol=0.02 * 0.4)
    assert filtered.k[30, 36] == pytest.approx(2 * np.pi * 5**2, rel=0.02)
    assert filtered.k[0, 0] == pytest.approx(filtered.k[30, 36] / 4, rel=0.3), (
        "beyond the corner there is nothing"
    )


@pytest.mark.parametrize("method", [by_definition, fast_bilateral])
@pytest.mark.parametrize("sigma_s", [2, 7])
def test_an_isolated_pixel_keeps_its_value_and_k_is_1(method, sigma_s):
    v = np.zeros((50, 60))
    v[20, 33] = 5
    filtered = method(v, sigma_s=sigma_s, sigma_r=0.4)
    assert filtered.mean[20, 33] == pytest.approx(5, abs=0.02)
    assert filtered.k[20, 33] == pytest.approx(1, abs=0.25)
    others = filtered.mean.copy()
    others[20, 33] = 0
    assert np.abs(others).max() < 0.01, "all other pixels stay dark"


@pytest.mark.parametrize("method", [by_definition, fast_bilateral])
def test_a_large_sigma_r_gives_the_gaussian_blur(method):
    v = room((60, 80))
    plain = gaussian_filter(v.astype(np.float64), 4, truncate=3, mode="constant")
    weight = gaussian_filter(np.ones(v.shape), 4, truncate=3, mode="constant")
    assert rms(method(v, sigma_s=4, sigma_r=100).mean, plain / weight) < 0.02


def test_a_hard_edge_is_kept_and_texture_is_removed():
    rng = np.random.default_rng(1)
    v = np.where(np.arange(80) < 40, 0.0, 3.0) + 0.1 * rng.standard_normal((60, 80))
    mean = fast_bilateral(v, sigma_s=6, sigma_r=0.4).mean
    assert np.abs(mean[:, :40]).max() < 0.06 and np.abs(mean[:, 40:] - 3).max() < 0.06


@settings(max_examples=40, deadline=None)
@given(
    height=st.integers(1, 40),
    width=st.integers(1, 40),
    sigma_s=st.floats(0.02, 30),
    sigma_r=st.floats(0.1, 10),
)
def test_the_result_stays_within_the_range_of_the_signal(height, width, sigma_s, sigma_r):
    v = room((height, width))
    filtered = fast_bilateral(v, sigma_s=sigma_s, sigma_r=sigma_r)
    assert filtered.mean.shape == filtered.k.shape == v.shape and filtered.mean.dtype == np.float32
    slack = 0.05 * sigma_r  # half a bin of the histograms, at most
    assert np.all((filtered.mean >= v.min() - slack) & (filtered.mean <= v.max() + slack))
    assert np.all(filtered.k > 0)


def test_the_level_of_the_signal_does_not_matter():
    v = room()
    here = fast_bilateral(v, sigma_s=6, sigma_r=0.4)
    there = fast_bilateral(v + 40, sigma_s=6, sigma_r=0.4)
    assert np.allclose(there.mean - 40, here.mean, atol=1e-3)


@pytest.mark.parametrize("method", [by_definition, fast_bilateral])
def test_invalid_signals_and_widths_raise_an_error(method):
    for v in (
        np.ones(4),
        np.ones((2, 2, 3)),
        np.ones((0, 3)),
        np.full((3, 3), np.nan),
        np.full((3, 3), np.inf),
    ):
        with pytest.raises(ValueError, match="finite signal"):
            method(v, sigma_s=2, sigma_r=0.4)
    for sigma_s, sigma_r in ((0, 1), (1, 0), (-1, 1), (np.nan, 1), (1, np.inf)):
        with pytest.raises(ValueError, match="sigma_s"):
            method(np.ones((3, 3)), sigma_s=sigma_s, sigma_r=sigma_r)


def test_a_signal_with_too_large_a_range_raises_an_error():
    with pytest.raises(ValueError, match="range of at most 5 for"):
        fast_bilateral(np.array([[0, 6]]), sigma_s=1, sigma_r=0.01)
