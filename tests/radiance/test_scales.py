"""The scale factors of color channels, and weights by signal-to-noise ratio."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from hdrlab.capture import responses
from hdrlab.core import weights
from hdrlab.errors import InputError
from hdrlab.radiance import scales


@given(seed=st.integers(0, 99), red=st.floats(0.05, 20), blue=st.floats(0.05, 20))
def test_known_channel_scales_are_recovered(seed, red, blue):
    M = np.random.default_rng(seed).uniform(0.05, 1, (200, 3))
    assert np.allclose(scales.fit_channel_scales(M / [red, 1, blue], M), [red, 1, blue], rtol=1e-4)


@pytest.mark.parametrize("seed", range(3))
def test_no_neighbour_of_the_scales_fits_better(seed):
    rng = np.random.default_rng(seed)
    M = rng.uniform(0.05, 1, (300, 3))
    light = M**2.2 * [3.0, 1.0, 0.4] * np.exp(rng.normal(0, 0.1, M.shape))

    def misfit(k):
        return np.sum((scales.chromaticity(k * light) - scales.chromaticity(M)) ** 2)

    k = scales.fit_channel_scales(light, M)
    for step in ([1.01, 1, 1], [0.99, 1, 1], [1, 1, 1.01], [1, 1, 0.99]):
        assert misfit(k) < misfit(k * step)


def test_channel_scales_do_not_depend_on_brightness_or_array_shape():
    rng = np.random.default_rng(0)
    M = rng.uniform(0.2, 1, (6, 7, 3))
    light = M * [2.0, 1, 0.5] * np.exp(rng.normal(0, 0.1, M.shape))
    k = scales.fit_channel_scales(light, M)
    brighter = np.exp(rng.normal(0, 2, (6, 7, 1)))
    assert np.allclose(scales.fit_channel_scales(light * brighter, M / brighter), k, rtol=1e-5)
    assert np.allclose(scales.fit_channel_scales(light.reshape(-1, 3), M.reshape(-1, 3)), k)


def test_grays_stay_gray():
    """A neutral pixel determines the scales: after scaling, the middle levels of the three curves are
    gray.
    """
    k = scales.fit_channel_scales([[0.2, 0.4, 0.8]], [[0.5, 0.5, 0.5]])
    assert np.allclose(k, [2, 1, 0.5], rtol=1e-5)


@pytest.mark.parametrize(
    ("light", "M"),
    [
        (np.ones((4, 3)), np.ones((5, 3))),
        (np.ones((4, 2)), np.ones((4, 2))),
        (np.zeros((4, 3)), np.ones((4, 3))),
        (np.ones((4, 3)), np.full((4, 3), np.nan)),
        (np.ones((0, 3)), np.ones((0, 3))),
    ],
)
def test_inputs_without_chromaticity_raise_an_error(light, M):
    with pytest.raises(InputError):
        scales.fit_channel_scales(light, M)


# The weight f / f'


@pytest.mark.parametrize("n", [256, 65536])
@pytest.mark.parametrize("gamma", [0.5, 1.0, 2.2])
def test_the_snr_weight_of_a_power_law_is_proportional_to_the_level(gamma, n):
    """f = M^gamma: f / f' = M / gamma, and gamma cancels with the scale."""
    g = gamma * np.log(np.maximum(np.arange(n), 0.25) / (n // 2))
    w = weights.snr(g)
    inner = slice(n // 12, n - 8)
    assert np.allclose(w[inner], np.arange(n)[inner] / (n // 2), rtol=0.02)
    assert w[0] == w[-1] == 0 and np.isclose(w[n // 2], 1)


@pytest.mark.parametrize("name", sorted(responses.RESPONSES))
def test_the_snr_weight_is_the_inverse_of_the_effect_of_noise(name):
    """Noise that is equal at all levels changes ln f by f' / f.

    Times the weight, this is constant.
    """
    g = responses.true_g(name)
    even = weights.snr(g)[20:240] * np.gradient(g)[20:240]
    assert np.ptp(even) < 0.1 * even.mean()


def test_the_snr_weight_is_finite_and_positive_where_the_response_is_flat():
    g = responses.true_g("film").copy()
    g[250:] = g[250]
    g[60:75] = g[60]
    w = weights.snr(g)
    assert np.all(np.isfinite(w)) and np.all(w[1:-1] > 0)


def test_all_channels_share_one_snr_weight_independent_of_the_unit():
    g = responses.true_g("film")
    assert np.allclose(weights.snr(np.stack([g] * 3, axis=-1)), weights.snr(g))
    assert np.allclose(weights.snr(g + 5), weights.snr(g))


@pytest.mark.parametrize(
    "g", [np.zeros(256), np.full(256, np.nan), np.zeros((2, 2, 2)), -np.arange(256.0)]
)
def test_invalid_responses_raise_an_error(g):
    with pytest.raises(ValueError, match="expected a"):
        weights.snr(g)


@given(k=st.floats(1e-3, 1e3), x=st.integers(0, 59), y=st.integers(0, 39))
def test_one_light_meter_reading_determines_the_unit(k, x, y):
    cd = 10 ** np.random.default_rng(7).uniform(0, 3, (40, 60))
    around = cd[max(y - 1, 0) : y + 2, max(x - 1, 0) : x + 2].mean()
    assert np.isclose(scales.fit_unit(cd / k, x, y, around), k, rtol=1e-4)


@pytest.mark.parametrize(
    ("x", "y", "reading"), [(60, 0, 1), (-1, 0, 1), (0, 40, 1), (5, 5, 0), (5, 5, np.nan)]
)
def test_an_invalid_meter_reading_raises_an_error(x, y, reading):
    with pytest.raises(ValueError, match="cd/m"):
        scales.fit_unit(np.ones((40, 60)), x, y, reading)


def test_a_dim_place_may_have_less_than_a_candela_per_square_metre():
    assert scales.fit_unit(np.full((20, 30), 0.5), 10, 5, 0.25) == 0.5
