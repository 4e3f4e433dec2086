"""Errors relative to a true map: zero for equal maps, closed forms, invariance to the unit."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from hdrlab.core import metrics

LINEAR = np.log(np.maximum(np.arange(256), 0.25) / 128)


def truth(shape=(20, 30, 3)):
    return np.random.default_rng(1).uniform(1, 100, shape).astype(np.float32)


@given(st.floats(-5, 5))
def test_a_response_in_another_unit_of_exposure_has_no_error(shift):
    assert np.allclose(metrics.response_rmse(LINEAR + shift, LINEAR), 0, atol=1e-9)


def test_the_error_of_a_response_is_the_rms_left_by_the_best_factor():
    X = np.arange(10, 251) / 250
    Y = X**1.1
    s = np.linalg.lstsq(Y[:, None], X, rcond=None)[0][0]
    expected = 100 * np.sqrt(np.mean((s * Y - X) ** 2))
    assert np.allclose(metrics.response_rmse(1.1 * LINEAR, LINEAR), expected)
    assert 1 < expected < 3


def test_each_channel_has_its_own_error_and_one_truth_serves_all():
    curves = np.stack([LINEAR, 1.1 * LINEAR, 1.3 * LINEAR], axis=-1)
    red, green, blue = metrics.response_rmse(curves, LINEAR)
    assert red < 1e-9 < green < blue


def test_levels_outside_10_to_250_do_not_count():
    curve = LINEAR.copy()
    curve[:10] -= 3
    curve[251:] += 3
    assert np.allclose(metrics.response_rmse(curve, LINEAR), 0, atol=1e-9)


def test_a_response_of_65536_levels_compares_with_one_of_256():
    fine = np.log(np.maximum(np.arange(65536), 64) / 32768)
    assert metrics.response_rmse(fine, LINEAR).max() < 0.01


def test_responses_whose_channels_do_not_fit_raise_an_error():
    with pytest.raises(ValueError, match=r"response \(n,\) or \(n, 3\).*shape"):
        metrics.response_rmse(np.stack([LINEAR] * 3, axis=-1), np.stack([LINEAR] * 2, axis=-1))


def test_a_pixel_is_well_exposed_if_all_channels_of_one_frame_are_within_10_to_250():
    images = np.array(
        [[[[9, 100, 100], [0, 0, 0], [10, 250, 128]]], [[[251, 200, 200], [10, 10, 10], [0, 0, 0]]]]
    )
    assert metrics.well_exposed(images.astype(np.uint8)).tolist() == [[False, True, True]]


def test_masked_pixels_are_not_well_exposed():
    images = np.full((2, 1, 2), 100, np.uint8)
    valid = np.array([[[True, False]], [[False, False]]])
    assert metrics.well_exposed(images, valid).tolist() == [[True, False]]


@given(st.floats(1e-3, 1e3))
def test_a_map_in_another_unit_of_radiance_has_no_error(unit):
    E = truth()
    assert np.allclose(metrics.radiance_errors(unit * E, E, np.ones((20, 30), bool)), 0, atol=1e-5)


def test_a_pixel_twice_too_bright_is_off_by_one_and_the_median_pixel_by_nothing():
    E = truth()
    wrong = E.copy()
    wrong[3, 4] *= 2
    off = metrics.radiance_errors(wrong, E, np.ones((20, 30), bool))
    assert np.allclose(off[3, 4], 1, atol=1e-5) and np.median(off) == 0


def test_badly_exposed_pixels_do_not_affect_the_unit():
    E = truth()
    well = np.zeros((20, 30), bool)
    well[:5] = True
    wrong = np.where(well[..., None], E, 7 * E)
    assert np.allclose(metrics.radiance_errors(wrong, E, well)[well], 0, atol=1e-6)


def test_where_the_truth_is_without_light_there_is_no_relative_error():
    E = truth((4, 5))
    dark = E.copy()
    dark[0, 0] = 0
    assert np.argwhere(np.isnan(metrics.radiance_errors(E, dark, E > 0))).tolist() == [[0, 0]]


def test_maps_that_cannot_be_compared_raise_an_error():
    E = truth((4, 5))
    with pytest.raises(ValueError, match="one shape"):
        metrics.radiance_errors(E, E[1:], E > 0)
    with pytest.raises(ValueError, match="well-exposed pixel with light.*none"):
        metrics.radiance_errors(E, E, E < 0)


def test_offsets_are_compared_up_to_the_shift_that_most_frames_share():
    true = np.array([[0, 0], [3, -2], [1, 1], [5, 5]])
    offsets = true + [2, -7]
    offsets[3] += [0, 1]
    assert metrics.offset_errors(offsets, true).tolist() == [[0, 0], [0, 0], [0, 0], [0, 1]]


def test_offsets_that_do_not_pair_raise_an_error():
    with pytest.raises(ValueError, match="offsets"):
        metrics.offset_errors([[0, 0]], [[0, 0], [1, 1]])
