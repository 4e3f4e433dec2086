"""hdrlab.tonemap.curves: linear, gamma, logarithm, quantization; curves are no operators."""

from functools import partial

import numpy as np
import pytest
from hypothesis import given, strategies as st
from support import laws

from hdrlab.core import colour
from hdrlab.core.extremes import robust_maximum, robust_minimum
from hdrlab.errors import InputError
from hdrlab.tonemap import curves, reinhard

CURVES = {name: partial(curves.tonemap, curve=name) for name in curves.CURVES}


@pytest.mark.parametrize("law", laws.ALWAYS, ids=lambda law: law.__name__)
@pytest.mark.parametrize("name", CURVES)
def test_every_curve_obeys_the_laws(name, law):
    law(CURVES[name])


@pytest.mark.parametrize("claim", curves.LAWS)
@pytest.mark.parametrize("name", CURVES)
def test_every_curve_obeys_the_laws_that_the_module_claims(name, claim):
    laws.CLAIMED[claim](CURVES[name])


def test_the_curves_are_their_formulas():
    L = np.float32([[1, 10, 100]])
    assert np.allclose(curves.linear(L, high=100), [[0.01, 0.1, 1]])
    assert np.allclose(curves.gamma(L, high=100, gamma=2), [[0.1, 0.31623, 1]], atol=1e-5)
    assert np.allclose(curves.logarithmic(L, low=1, high=100), [[0, 0.5, 1]])


def test_every_curve_maps_the_range_onto_the_display_and_clips_beyond():
    L = np.float32([[0, 0.5, 1, 7, 100, 1e5]])
    for F in (
        curves.linear(L, high=100),
        curves.gamma(L, high=100),
        curves.logarithmic(L, low=1, high=100),
    ):
        assert F[0, 0] == 0 and F[0, 4] == pytest.approx(1) and F[0, 5] == pytest.approx(1)


def test_gamma_divides_every_log_ratio():
    ratio = np.diff(np.log(curves.gamma(np.float32([[1, 8]]), high=100, gamma=3.0)))
    assert ratio[0, 0] == pytest.approx(np.log(8) / 3, rel=1e-5)


def test_the_logarithm_gives_every_stop_the_same_range():
    steps = np.diff(
        curves.logarithmic(2.0 ** np.arange(11, dtype=np.float32)[None], low=1, high=1024)
    )
    assert np.allclose(steps, 0.1, atol=1e-6)


def test_linear_scaling_loses_most_of_a_wide_scene():
    """The point of the slide: values below one level of 256 are lost, and so is half of this scene."""
    L = np.geomspace(1e-3, 32, 4096, dtype=np.float32)[None]
    lost = np.mean(curves.quantise(curves.tonemap(L, curve="linear", encoded=False)) == 0)
    assert lost == pytest.approx(np.log(32 / 510 / 1e-3) / np.log(32 / 1e-3), abs=0.01)
    assert np.mean(curves.quantise(curves.tonemap(L, curve="log", encoded=False)) == 0) < 0.01


@pytest.mark.parametrize("name", CURVES)
def test_an_encoded_curve_becomes_the_levels_of_the_picture_as_it_is(name):
    L = laws.scene()
    F = curves.tonemap(L, curve=name, encoded=False)
    Ld = curves.tonemap(L, curve=name, encoded=True)
    assert np.abs(curves.quantise(F).astype(int) - colour.to_8bit(Ld)).max() <= 1


@given(F=st.floats(0, 1), levels=st.sampled_from([2, 16, 256, 1024, 65536]))
def test_quantising_rounds_to_the_nearest_level(F, levels):
    Q = curves.quantise(F, levels=levels)
    assert Q.dtype == (np.uint8 if levels <= 256 else np.uint16)
    assert abs(float(Q) - (levels - 1) * F) <= 0.5 + 1e-9


def test_quantising_uses_every_level_once():
    assert np.array_equal(curves.quantise(np.arange(256) / 255), np.arange(256))
    assert curves.quantise([0.5], levels=2)[0] == 1, "halves go up"


def test_quantise_raises_an_error_for_values_out_of_range():
    with pytest.raises(ValueError, match="3 outside"):
        curves.quantise([0.5, 1.2, -0.1, np.nan])
    for levels in (1, 65537):
        with pytest.raises(ValueError, match="levels"):
            curves.quantise([0.5], levels=levels)


def test_spread_is_narrow_for_a_curve_and_wide_for_a_local_operator():
    L = laws.scene()
    for Ld in (curves.tonemap(L), reinhard.tonemap(L)):
        luminance, least, greatest = curves.spread(L, Ld)
        assert np.all(np.diff(luminance) >= 0) and np.all(least[1:] >= greatest[:-1] - 1e-6)
    _, least, greatest = curves.spread(L, reinhard.tonemap(L, local=True))
    assert np.mean(least[1:] < greatest[:-1] - 0.01) > 0.3


@pytest.mark.parametrize(
    "knobs", [{"curve": "cubic"}, {"gamma": 0}, {"gamma": np.inf}, {"cut": 0.5}, {"cut": -0.1}]
)
def test_invalid_parameters_raise_an_error(knobs):
    with pytest.raises(InputError):
        curves.tonemap(np.ones((3, 3)), **knobs)


def test_robust_extremes_ignore_a_hot_a_dead_and_black_pixels():
    L = np.float32(np.arange(2, 102)).reshape(10, 10)
    L[0, 0] = 1e-9
    L[9, 9] = 1e9
    assert (robust_minimum(L), robust_maximum(L)) == (3, 100)
    assert robust_minimum(np.where(L < 50, 0, L)) == 51
    assert robust_minimum(L, cut=0.1) == 12 and robust_maximum(L, cut=0.1) == 91


def test_robust_extremes_of_tiny_and_black_images_are_defined():
    for extreme in (robust_minimum, robust_maximum):
        assert extreme(np.zeros((3, 4), np.float32)) == 0
        assert extreme(np.full((1, 1), 5, np.float32)) == 5
        assert extreme(np.float32([[0, 7]])) == 7


def test_extremes_of_a_large_picture_are_those_of_all_its_pixels_nearly():
    L = np.exp(np.random.default_rng(3).standard_normal((1200, 1100))).astype(np.float32)
    assert np.log(robust_maximum(L, cut=0.01)) == pytest.approx(
        np.log(np.quantile(L, 0.99)), abs=0.03
    )
    assert np.log(robust_minimum(L, cut=0.01)) == pytest.approx(
        np.log(np.quantile(L, 0.01)), abs=0.03
    )
