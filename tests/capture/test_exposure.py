"""Exposure: identities of exposure values, and the true values of camera dials."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from hdrlab.capture import exposure

TIMES = st.floats(1e-4, 60)
NUMBERS = st.floats(0.7, 64)


@given(F=NUMBERS, T=TIMES)
def test_halving_the_time_adds_one_ev(F, T):
    assert exposure.ev(F, T / 2) - exposure.ev(F, T) == pytest.approx(1)


@given(F=NUMBERS, T=TIMES)
def test_stopping_down_by_the_root_of_two_adds_one_ev_and_doubling_the_speed_takes_one(F, T):
    assert exposure.ev(F * np.sqrt(2), T) - exposure.ev(F, T) == pytest.approx(1)
    assert exposure.ev(F, T) - exposure.ev(F, T, S=200) == pytest.approx(1)


@given(F=NUMBERS, T=TIMES, other=NUMBERS)
def test_equivalent_exposures_have_one_ev_and_one_saturating_luminance(F, T, other):
    same = exposure.equivalent_time(T, F, other)
    assert exposure.ev(other, same) == pytest.approx(exposure.ev(F, T))
    assert exposure.saturating_luminance(same, F=other) == pytest.approx(
        exposure.saturating_luminance(T, F=F)
    )


@pytest.mark.parametrize(
    ("name", "really"),
    [("1/60", 64), ("1/125", 128), ("1/250", 256), ("1/500", 512), ("1/1000", 1024), ("1/15", 16)],
)
def test_a_shutter_marked_so_opens_for_a_power_of_two(name, really):
    assert 1 / exposure.true_time(exposure.seconds(name)) == really
    dial = exposure.shutter_series()
    assert 1 / dial.values[dial.names.index(name)] == really


@pytest.mark.parametrize("per_stop", [1, 3])
def test_the_names_of_a_dial_are_within_seven_percent_of_what_it_does(per_stop):
    dial = exposure.shutter_series(per_stop)
    seconds = np.array([exposure.seconds(name) for name in dial.names])
    assert len(seconds) == len(dial.values) and np.abs(seconds / dial.values - 1).max() < 0.07


@pytest.mark.parametrize("per_stop", [1, 3])
def test_neighbours_on_a_dial_differ_by_one_or_a_third_of_a_stop(per_stop):
    steps = np.diff(np.log2(exposure.shutter_series(per_stop).values))
    assert steps == pytest.approx(np.full(len(steps), -1 / per_stop))


def test_every_name_of_the_dial_leads_to_its_own_true_time():
    dial = exposure.shutter_series(3)
    assert [exposure.true_time(exposure.seconds(name)) for name in dial.names] == pytest.approx(
        dial.values
    )


def test_a_filter_of_density_0_3_takes_a_stop_and_1000_times_takes_ten():
    assert exposure.transmittance(0.3) == pytest.approx(0.5, abs=0.002)
    assert exposure.transmittance(exposure.density(10)) == pytest.approx(1 / 1024)
    assert exposure.stops(1, exposure.transmittance(exposure.density(3))) == pytest.approx(3)


def test_a_sunlit_white_wall_fills_the_levels_near_the_sunny_sixteen_rule():
    """f/16 and 1 / ISO seconds suit a sunlit scene: its white, 30 000 cd/m^2, is just below the top
    level.
    """
    assert exposure.saturating_luminance(1 / 128, F=16, S=100) == pytest.approx(39322, rel=0.01)


@pytest.mark.parametrize("text", ["", "1/0", "-1", "0", "fast", "1/", "inf", "nan"])
def test_an_invalid_shutter_time_raises_an_error(text):
    with pytest.raises(ValueError, match="shutter time"):
        exposure.seconds(text)


@pytest.mark.parametrize("bad", [0, -1, np.inf, np.nan])
def test_settings_must_be_positive(bad):
    for call in (
        lambda: exposure.ev(bad, 1),
        lambda: exposure.ev(1, bad),
        lambda: exposure.true_time(bad),
    ):
        with pytest.raises(ValueError, match="positive"):
            call()
    with pytest.raises(ValueError, match="1 or 3"):
        exposure.shutter_series(2)


@pytest.mark.parametrize("angle", [0.0, 0.3, 0.75])
def test_the_irradiance_is_all_that_a_small_aperture_sends_to_a_spot_of_the_sensor(angle):
    # mm
    h = 50.0
    d = 50 / 16
    n = 401
    x = (np.arange(n) + 0.5) / n * d - d / 2
    inside = np.hypot(x[:, None], x) < d / 2
    # from a spot off the axis to the aperture
    square = h**2 + x[:, None] ** 2 + (x - h * np.tan(angle)) ** 2
    cosine = h / np.sqrt(square)  # the aperture is seen aslant, and the light falls aslant
    arrived = 1000 * np.sum((cosine**2 / square)[inside]) * (d / n) ** 2
    assert exposure.irradiance(1000, 16, angle=angle) == pytest.approx(arrived, rel=3e-3)


def test_irradiance_goes_down_by_a_stop_where_the_aperture_does():
    assert exposure.irradiance(5.0, 8 * np.sqrt(2)) == pytest.approx(
        exposure.irradiance(5.0, 8) / 2
    )
    with pytest.raises(ValueError, match="f-number"):
        exposure.irradiance(1.0, 0)


def test_nominal_times_of_a_camera_become_true_times_if_the_dial_has_them():
    dial = exposure.read_dial(["30", "1/60", "0.0166s", "time", "1/16000", "x 200"])
    assert dial.names == ("30", "1/60", "0.0166s", "1/16000")
    assert dial.values.tolist() == [32, 1 / 64, 1 / 64, 1 / 16000]
