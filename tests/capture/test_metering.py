"""Metering: the pixels that each mode weights, and the exposure that follows."""

from functools import partial

import numpy as np
import pytest

from hdrlab.capture import autoexposure, exposure, metering
from hdrlab.core.colour import luminance
from hdrlab.errors import InputError
from hdrlab.scenes import subjects

SHAPE = (80, 120)
SCENES = {name: make((96, 144)) for name, make in subjects.SUBJECTS.items()}


def settled(name, mode, **knobs):
    """Return how many stops too bright the subject is when `mode` sets the exposure."""
    scene = SCENES[name]
    EV = autoexposure.expose(scene.E, mode, **knobs)
    B = luminance(scene.E) / exposure.saturating_luminance(64 / 2**EV)
    return np.log2(B[scene.mask].mean() / scene.rho)


@pytest.mark.parametrize("mode", metering.MODES)
def test_weights_are_positive_somewhere_and_sum_to_one(mode):
    w = metering.weights(np.full(SHAPE, 0.3), mode)
    assert w.shape == SHAPE and w.min() >= 0 and w.sum() == pytest.approx(1)


@pytest.mark.parametrize("mode", metering.MODES)
def test_an_even_picture_reads_the_same_in_every_mode(mode):
    B = np.full(SHAPE, 0.3)
    assert metering.reading(B, metering.weights(B, mode)) == pytest.approx(0.3)


@pytest.mark.parametrize(("mode", "low", "high"), [("spot", 0.01, 0.05), ("partial", 0.10, 0.15)])
def test_spot_metering_covers_1_to_5_percent_and_partial_10_to_15(mode, low, high):
    assert low <= (metering.weights(np.ones(SHAPE), mode) > 0).mean() <= high


@pytest.mark.parametrize("inside", [0.6, 0.7, 0.8])
def test_centre_gives_its_share_of_the_weight_to_the_central_quarter(inside):
    w = metering.centre(SHAPE, inside=inside)
    assert np.sort(w.ravel())[::-1][: w.size // 4].sum() >= inside - 0.005
    assert w[metering.spot(SHAPE, share=0.25) > 0].sum() == pytest.approx(inside, abs=1e-3)
    row = w[40, 60:]
    assert np.all(np.diff(row) < 0)
    assert row[-1] > 0  # feathered: it falls all the way, and never to nothing


def test_the_spot_can_be_placed_anywhere():
    B = np.zeros(SHAPE)
    B[60:, 90:] = 0.5
    assert metering.reading(B, metering.spot(SHAPE, at=(0.9, 0.9), share=0.01)) == pytest.approx(
        0.5
    )
    assert metering.reading(B, metering.spot(SHAPE)) == 0


def test_a_matrix_meter_divides_the_picture_into_28_zones():
    labels = metering.zones((200, 300))
    assert np.array_equal(np.unique(labels), np.arange(28))
    assert np.bincount(labels.ravel()).min() > 100
    with pytest.raises(ValueError, match="read-only"):  # they are kept for the next shot
        labels[0, 0] = 9


def test_a_matrix_meter_gives_the_bare_sun_little_weight():
    B = np.full(SHAPE, 0.05)
    B[:16, :20] = 1.0
    assert metering.reading(B, metering.matrix(B)) == pytest.approx(0.05, rel=0.05)
    assert metering.reading(B, metering.average(SHAPE)) > 0.07


def test_a_matrix_meter_gives_the_focus_point_more_weight():
    B = np.full(SHAPE, 0.1)
    B[:, 60:] = 0.3
    left = metering.reading(B, metering.matrix(B, at=(0.5, 0.2)))
    right = metering.reading(B, metering.matrix(B, at=(0.5, 0.8)))
    assert left < 0.15 < 0.25 < right


def test_without_full_pixels_the_correction_is_the_formula():
    rng = np.random.default_rng(1)
    B = rng.uniform(0.01, 0.09, SHAPE)
    w = metering.average(SHAPE)
    formula = metering.optimum(0.0, metering.reading(B, w))
    assert -metering.correction(B, w) == pytest.approx(formula, abs=1e-6)


@pytest.mark.parametrize("start", [6, 12, 18])
@pytest.mark.parametrize("mode", metering.MODES)
@pytest.mark.parametrize("name", SCENES)
def test_automatic_exposure_is_within_a_sixth_of_a_stop_after_at_most_four_shots(name, mode, start):
    """At the end, a photo without noise has a reading of 0.18 within a sixth of a stop."""
    photograph = partial(autoexposure.measure_brightness, full_well=20_000, read_noise=5, rng=3)
    states = list(
        autoexposure.expose_steps(SCENES[name].E, mode, start=start, photograph=photograph)
    )
    assert len(states) <= 4
    B = autoexposure.measure_brightness(SCENES[name].E, states[-1].EV_opt)
    read = metering.reading(B, metering.weights(B, mode))
    assert abs(np.log2(read / metering.MIDDLE_GRAY)) < 1 / 6


def test_against_the_light_only_the_narrow_modes_expose_the_face():
    off = {mode: settled("backlight", mode) for mode in metering.MODES}
    assert abs(off["spot"]) < 1.5 and abs(off["partial"]) < 1.5  # a face is a stop above gray
    assert off["centre"] < -3 and off["average"] < off["centre"]


@pytest.mark.parametrize("mode", metering.MODES)
def test_snow_comes_out_gray_in_every_mode_and_two_stops_more_make_it_white(mode):
    off = settled("snow", mode)
    assert -2.5 < off < -1.9
    assert abs(settled("snow", mode, target=metering.MIDDLE_GRAY * 2**-off)) < 0.2


def test_a_black_locomotive_comes_out_gray_where_the_spot_lies_on_it():
    assert 1.9 < settled("locomotive", "spot") < 2.5 and settled("locomotive", "average") < 0


def test_twice_the_light_gives_one_ev_more():
    E = SCENES["snow"].E
    assert autoexposure.expose(2 * E, start=13) - autoexposure.expose(E, start=12) == pytest.approx(
        1, abs=0.01
    )


def test_autoexposure_recovers_from_a_black_or_burnt_out_first_shot():
    for start in (-10, 40):
        states = list(
            autoexposure.expose_steps(SCENES["snow"].E, "average", start=start, max_shots=20)
        )
        assert abs(np.log2(states[-1].B_pre / metering.MIDDLE_GRAY)) < 1 / 6


def test_invalid_arguments_raise_an_error():
    B = np.full(SHAPE, 0.3)
    for call in (
        lambda: metering.weights(B, "matrx"),
        lambda: metering.spot(SHAPE, at=(0.5, 1.5)),
        lambda: metering.spot(SHAPE, share=0),
        lambda: metering.centre(SHAPE, inside=0.1),
        lambda: metering.reading(B, np.zeros(SHAPE)),
        lambda: metering.reading(B, np.ones((3, 3))),
        lambda: subjects.snow((0, 3)),
    ):
        with pytest.raises(InputError):
            call()


@pytest.mark.parametrize("name", SCENES)
def test_each_metering_scene_has_a_subject_of_known_reflectance(name):
    scene = SCENES[name]
    assert np.all(np.isfinite(scene.E)) and scene.E.min() > 0
    assert 0.02 < scene.mask.mean() < 0.9
    assert {"backlight": 0.45, "snow": 0.86, "locomotive": 0.05}[name] == pytest.approx(
        scene.rho, rel=0.15
    )


def test_the_center_weights_are_gaussian_and_never_0():
    """The logarithm of the weights decreases with the squared distance, inside and outside of the core."""
    w = metering.centre((61, 61))
    away = (np.arange(61) - 30.0) ** 2
    slope = np.diff(np.log(w[30])) / np.where(np.diff(away), np.diff(away), np.nan)
    assert np.allclose(slope, slope[0], rtol=1e-6) and slope[0] < 0 and w.min() > 0
