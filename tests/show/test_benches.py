"""What a sensor loses, drawn; and the two benches: place the spot, and shoot from the hand."""

import numpy as np
import pytest

from hdrlab import scenes
from hdrlab.capture import autoexposure, metering, photon_transfer, planning, ranges, sensor
from hdrlab.core.colour import luminance
from hdrlab.errors import InputError
from hdrlab.scenes import subjects
from hdrlab.show import pictures
from hdrlab.show.plots.lectures import benches, sensors

BACKLIGHT = subjects.backlight((96, 144))
L = np.geomspace(0.01, 10, 500)


# The bench of the spot


def test_the_spot_on_the_face_exposes_it_and_loses_the_sky():
    on, off = (benches.meter_scene(BACKLIGHT, "spot", at) for at in ((0.45, 0.5), (0.1, 0.1)))
    assert abs(on.off) < 1.5 and on.full.mean() > 0.3
    assert off.off < -3 and off.full.mean() < 0.01
    assert off.EV > on.EV + 3


def test_what_the_bench_says_of_the_subject_is_what_its_picture_shows():
    shot = benches.meter_scene(BACKLIGHT, "spot", (0.45, 0.5))
    B = luminance(shot.picture[BACKLIGHT.mask].astype(float)[None] ** 2.2 / 255**2.2).mean()
    assert np.log2(B / BACKLIGHT.rho) == pytest.approx(shot.off, abs=0.25)


def test_a_poor_sensor_loses_the_shadows_of_the_same_shot():
    good, poor = (
        benches.meter_scene(BACKLIGHT, "average", sensor=sensor.Sensor(read_noise=noise))
        for noise in (5, 300)
    )
    assert good.EV == poor.EV and poor.noise.mean() > good.noise.mean() + 0.1


@pytest.mark.parametrize("mode", metering.MODES)
def test_every_mode_shows_whom_it_asks_and_the_spot_is_small(mode):
    asked = benches.meter_scene(BACKLIGHT, mode).asked
    assert asked.shape == BACKLIGHT.mask.shape and asked.any()
    assert (asked.mean() < 0.06) == (mode == "spot")


def test_a_shot_is_drawn_with_what_it_lost_marked():
    shot = benches.meter_scene(BACKLIGHT, "spot", (0.45, 0.5))
    drawn = pictures.render(benches.draw_shot(shot))
    share = np.all(drawn == sensors.ORANGE, axis=-1).mean()
    assert 0.2 < share < shot.full.mean()  # the text above takes its part


def test_each_step_of_automatic_exposure_is_drawn():
    steps = list(autoexposure.expose_steps(BACKLIGHT.E, "centre"))
    frames = [pictures.render(benches.draw_reading(state)) for state in steps]
    assert len({frame.shape for frame in frames}) == 1 and np.any(frames[0] != frames[-1])


# The bench of the hand


def test_a_still_hand_needs_no_alignment_and_a_shaking_one_bends_the_curve_without_it():
    E = scenes.workshop((112, 168))
    still, shaking = (benches.calibrate_shaken(E, radius=radius) for radius in (0, 8))
    levels = slice(10, 251)
    off = {
        name: np.abs((g - one.truth)[levels]).max()
        for name, one in (("still", still), ("shaking", shaking))
        for g in (one.shot,)
    }
    mended = np.abs((shaking.aligned - shaking.truth)[levels]).max()
    assert still.wrong == shaking.wrong == 0
    assert off["still"] < 0.05 and off["shaking"] > 0.08 and mended < 0.05


def test_a_calibration_is_drawn_with_the_number_that_found_their_place():
    ax = benches.draw_calibrated(benches.calibrate_shaken(scenes.workshop((80, 120)), count=3))
    assert "3 of 3" in ax.get_title()
    assert [line.get_label() for line in ax.lines if line.get_label()[0] != "_"] == [
        "as shot",
        "aligned",
    ]


# Drawings


def test_full_pixels_are_orange_lost_ones_blue_and_the_rest_as_it_was():
    gray = np.full((2, 3), 90, np.uint8)
    full, noise = np.zeros((2, 3), bool), np.zeros((2, 3), bool)
    full[0, 0], noise[1, 1] = True, True
    shown = sensors.mark_lost(gray, full, noise)
    assert np.array_equal(shown[0, 0], sensors.ORANGE) and np.array_equal(shown[1, 1], sensors.BLUE)
    assert np.all(shown[0, 1:] == 90) and np.all(gray == 90)


def test_a_window_says_how_many_pixels_are_held():
    held = ranges.expose_levels(L, 1.0, sensor.Sensor())
    ax = sensors.window(L, held)
    said = [text.get_text() for text in ax.get_legend().get_texts()]
    assert (
        said[1] == f"held: {(~held.full & ~held.noise).mean():.0%}" and "cd/m²" in ax.get_xlabel()
    )


def test_a_staircase_has_the_levels_of_the_converter():
    few = sensor.Sensor(bits=3, gain=20_000 / 7, black=0)
    ax = sensors.staircase(L, ranges.expose_levels(L, 1.0, few))
    assert np.array_equal(np.unique(ax.lines[0].get_ydata()), np.arange(8))
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["lost in noise", "full"]


def test_a_transfer_curve_has_a_line_of_slope_one_over_the_gain():
    S = np.linspace(0, 4000, 9)
    found = photon_transfer.Transfer(
        gain=5.0, read_noise=5.0, black=64.0, full_well=20_000.0, S=S, V=1 + S / 5, used=S < 3000
    )
    line = sensors.transfer(found).lines[-1]
    (x0, x1), (y0, y1) = line.get_xdata(), line.get_ydata()
    assert (y1 - y0) / (x1 - x0) == pytest.approx(0.2)


def test_a_plan_is_drawn_with_a_bar_for_each_photograph_over_what_it_holds():
    plan = planning.plan(0.1, 1000)
    ax = sensors.coverage(plan, 0.1, 1000)
    assert [tuple(line.get_xdata()) for line in ax.lines] == [tuple(held) for held in plan.holds]
    assert [text.get_text() for text in ax.texts] == [f"{name} s" for name in plan.names]


def test_bars_say_their_numbers():
    ax = sensors.bars(ranges.levels_per_stop(8), across="stop", up="levels")
    assert [text.get_text() for text in ax.texts] == ["128", "64", "32", "16", "8", "4", "2", "1"]


def test_a_titled_picture_keeps_its_proportions():
    drawn = pictures.render(sensors.draw_titled(np.zeros((100, 200), np.uint8), "two\nlines"))
    assert drawn.shape[1] == 540 and drawn.shape[0] == pytest.approx(270 + 60, abs=3)


def test_what_does_not_fit_together_is_refused():
    held = ranges.expose_levels(L, 1.0, sensor.Sensor())
    for call in (
        lambda: sensors.mark_lost(np.zeros((2, 3), np.uint8), np.zeros((3, 2)), np.zeros((2, 3))),
        lambda: sensors.window(L[1:], held),
        lambda: sensors.window(0 * L, held),
        lambda: sensors.staircase(L[1:], held),
        lambda: sensors.draw_titled(np.zeros((2, 3)), "text"),
    ):
        with pytest.raises(InputError):
            call()
