"""hdrlab.tonemap.durand: layers, compression, the fix where k is small."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from support import laws

from hdrlab.core.colour import luminance
from hdrlab.core.filters.bilateral import bilateral
from hdrlab.errors import InputError
from hdrlab.fast import durand as fast
from hdrlab.io.maps import rgbe
from hdrlab.tonemap import durand


@given(level=st.floats(1e-9, 1e9))
def test_a_flat_scene_has_no_detail_and_becomes_white(level):
    flat = np.full((20, 30), level)
    assert np.allclose(durand.tonemap(flat), 1, atol=0.03)
    layers = durand.layers(durand.logarithm(flat.astype(np.float32)), sigma_s=4)
    assert np.abs(layers.detail).max() < 0.012


def test_the_logarithm_has_the_base_ten_and_black_is_a_millionth_of_the_median():
    L = np.float32([[0, 1, 10, 1000, 10]])
    assert np.allclose(durand.logarithm(L), [[-5, 0, 1, 3, 1]], atol=1e-5)


def test_base_and_detail_add_up_to_the_logarithm():
    lL = durand.logarithm(laws.scene())
    layers = durand.layers(lL, sigma_s=5)
    assert np.allclose(layers.base + layers.detail, lL, atol=1e-6)


@pytest.mark.parametrize("contrast", [10, 50, 200])
def test_the_base_has_the_requested_contrast_between_its_percentiles(contrast):
    base = durand.layers(durand.logarithm(laws.scene()), sigma_s=5).base
    low, high = durand.base_range(base, cut=0.01)
    after = durand.compress(base, low, high, contrast=contrast)
    ends = durand.base_range(after, cut=0.01)
    assert ends[1] - ends[0] == pytest.approx(np.log10(contrast), rel=1e-4)
    assert ends[1] == pytest.approx(0, abs=1e-5)


def test_a_scene_of_little_contrast_is_not_stretched():
    base = np.linspace(0, 0.5, 100, dtype=np.float32)[None]
    assert np.allclose(durand.compress(base, 0, 0.5, contrast=50), base - 0.5)


def test_a_step_of_four_decades_is_compressed_to_the_contrast_with_a_sharp_edge():
    L = np.where(np.arange(120) < 60, 1.0, 1e4) * np.ones((80, 1))
    Ld = durand.tonemap(L, contrast=50)
    assert np.allclose(Ld[:, :60], 0.02, rtol=0.05) and np.allclose(Ld[:, 60:], 1, rtol=0.05)


def test_detail_keeps_its_ratio_on_either_side_of_a_bright_edge():
    bars = np.where(np.arange(200) % 8 < 4, 1.0, 1.3)
    L = np.where(np.arange(160)[:, None] < 80, 500 * bars, 0.5 * bars)
    Ld = durand.tonemap(L)
    for rows in (slice(20, 70), slice(90, 140)):
        part = (
            Ld[rows, 40:160] if rows.start > 80 else durand.combine(*_compressed(L))[rows, 40:160]
        )
        assert np.percentile(part, 90) / np.percentile(part, 10) == pytest.approx(1.3, rel=0.03)


def _compressed(L):
    base, detail = durand.layers(durand.logarithm(L.astype(np.float32)), sigma_s=4)
    return durand.compress(base, *durand.base_range(base)), detail


def test_a_flat_wall_beside_a_window_has_no_halo():
    """The image of a flat wall next to a bright window is flat."""
    L = np.where(np.arange(200) < 100, 1.0, 3000.0) * np.ones((100, 1))
    wall = durand.tonemap(L)[50, :100]
    assert wall.max() / wall.min() < 1.02


def test_an_isolated_pixel_gets_the_base_of_its_neighborhood():
    lL = np.zeros((60, 80), np.float32)
    lL[30, 40] = 3
    filtered = bilateral(lL, sigma_s=8, sigma_r=0.4)
    for fix_uncertain in (durand.fix_uncertain, fast.fix_uncertain):
        base = fix_uncertain(*filtered, sigma_s=8)
        assert filtered.mean[30, 40] > 2.9 and base[30, 40] < 0.3
        assert np.abs(np.delete(base.ravel(), 30 * 80 + 40)).max() < 0.01, (
            "the others have enough of their kind"
        )


def test_if_all_pixels_are_certain_the_base_is_the_bilateral_mean():
    filtered = bilateral(np.zeros((60, 80), np.float32), sigma_s=8, sigma_r=0.4)
    assert durand.fix_uncertain(*filtered, sigma_s=8) is filtered.mean


def test_the_weight_of_the_mean_rises_with_the_logarithm_of_k():
    mean = np.zeros((40, 40), np.float32)
    mean[20, 20] = 1
    enough = (2 * np.pi * 16.0) ** 0.5
    bases = []
    for k in (1, enough**0.5, enough):
        weight = np.full((40, 40), 1000, np.float32)
        weight[20, 20] = k
        bases.append(durand.fix_uncertain(mean, weight, sigma_s=4.0)[20, 20])
    assert bases[0] < 0.05
    assert bases[2] == 1
    assert bases[1] == pytest.approx((bases[0] + 1) / 2, abs=1e-4)


def test_more_contrast_is_a_darker_shadow():
    L = laws.scene()
    shadows = [np.percentile(durand.tonemap(L, contrast=c), 5) for c in (5, 50, 500)]
    assert shadows[0] > shadows[1] > shadows[2]


@pytest.mark.parametrize(
    "knobs",
    [
        {"contrast": 1},
        {"contrast": np.nan},
        {"cut": 0.5},
        {"cut": -0.1},
        {"sigma_s": 0},
        {"sigma_r": -1},
    ],
)
def test_invalid_parameters_raise_an_error(knobs):
    with pytest.raises(InputError):
        durand.tonemap(np.ones((3, 3)), **knobs)


@pytest.mark.parametrize("name", ["lobby", "venice"])
def test_real_maps_are_displayed_well_exposed(shared, name):
    Ld = fast.tonemap(luminance(rgbe.read(shared("hdri_cc0") / f"{name}.hdr")))
    assert 0.05 < np.median(Ld) < 0.4 and np.mean(Ld == 1) < 0.03 and np.mean(Ld < 1e-3) < 0.01
