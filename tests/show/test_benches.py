"""Plots of a sensor's range, and the simulated experiments of metering and camera shake."""

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


def test_spot_on_the_face_exposes_the_face_and_clips_the_sky():
    face = benches.meter_scene(BACKLIGHT, "spot", (0.45, 0.5))
    sky = benches.meter_scene(BACKLIGHT, "spot", (0.1, 0.1))
    assert abs(face.off) < 1.5 and face.full.mean() > 0.3
    assert sky.off < -3 and sky.full.mean() < 0.01
    assert sky.EV > face.EV + 3


def test_reported_error_of_the_subject_is_that_of_its_picture():
    shot = benches.meter_scene(BACKLIGHT, "spot", (0.45, 0.5))
    B = luminance(shot.picture[BACKLIGHT.mask].astype(float)[None] ** 2.2 / 255**2.2).mean()
    assert np.log2(B / BACKLIGHT.rho) == pytest.approx(shot.off, abs=0.25)


def test_noisier_sensor_loses_more_shadows_at_the_same_exposure():
    good = benches.meter_scene(BACKLIGHT, "average", sensor=sensor.Sensor(read_noise=5))
    poor = benches.meter_scene(BACKLIGHT, "average", sensor=sensor.Sensor(read_noise=300))
    assert good.EV == poor.EV and poor.noise.mean() > good.noise.mean() + 0.1


@pytest.mark.parametrize("mode", metering.MODES)
def test_every_mode_reports_its_metered_pixels_and_spot_is_the_smallest(mode):
    metered = benches.meter_scene(BACKLIGHT, mode).metered
    assert metered.shape == BACKLIGHT.mask.shape and metered.any()
    assert (metered.mean() < 0.06) == (mode == "spot")


def test_draw_shot_marks_clipped_pixels():
    shot = benches.meter_scene(BACKLIGHT, "spot", (0.45, 0.5))
    drawn = pictures.render(benches.draw_shot(shot))
    share = np.all(drawn == sensors.FULL_RGB, axis=-1).mean()
    assert 0.2 < share < shot.full.mean()  # the text above takes its part


def test_draw_reading_gives_frames_of_one_size_for_all_steps():
    steps = list(autoexposure.expose_steps(BACKLIGHT.E, "centre"))
    frames = [pictures.render(benches.draw_reading(state)) for state in steps]
    assert len({frame.shape for frame in frames}) == 1 and np.any(frames[0] != frames[-1])


# The bench of the hand


def test_camera_shake_spoils_the_response_unless_the_photos_are_aligned():
    E = scenes.workshop((112, 168))
    still = benches.calibrate_shaken(E, radius=0)
    shaken = benches.calibrate_shaken(E, radius=8)

    def max_error(g):
        return np.abs((g - still.truth)[10:251]).max()

    assert still.wrong == shaken.wrong == 0
    assert max_error(still.shot) < 0.05
    assert max_error(shaken.shot) > 0.08
    assert max_error(shaken.aligned) < 0.05


def test_draw_calibrated_states_the_number_of_aligned_photos():
    ax = benches.draw_calibrated(benches.calibrate_shaken(scenes.workshop((80, 120)), count=3))
    assert "3 of 3" in ax.get_title()
    assert [line.get_label() for line in ax.lines if line.get_label()[0] != "_"] == [
        "as shot",
        "aligned",
    ]


# Drawings


def test_mark_lost_makes_full_pixels_orange_and_noisy_ones_blue_and_keeps_the_rest():
    gray = np.full((2, 3), 90, np.uint8)
    full = np.zeros((2, 3), bool)
    noise = np.zeros((2, 3), bool)
    full[0, 0] = True
    noise[1, 1] = True
    shown = sensors.mark_lost(gray, full, noise)
    assert np.array_equal(shown[0, 0], sensors.FULL_RGB)
    assert np.array_equal(shown[1, 1], sensors.NOISE_RGB)
    assert np.all(shown[0, 1:] == 90) and np.all(gray == 90)


def test_window_states_the_fraction_of_recorded_pixels():
    held = ranges.expose_levels(L, 1.0, sensor.Sensor())
    ax = sensors.window(L, held)
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert labels[1] == f"recorded: {(~held.full & ~held.noise).mean():.0%}"
    assert "cd/m²" in ax.get_xlabel()


def test_staircase_shows_all_values_of_the_converter():
    few = sensor.Sensor(bits=3, gain=20_000 / 7, black=0)
    ax = sensors.staircase(L, ranges.expose_levels(L, 1.0, few))
    assert np.array_equal(np.unique(ax.lines[0].get_ydata()), np.arange(8))
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["lost in noise", "full"]


def test_line_of_a_photon_transfer_curve_has_slope_1_over_the_gain():
    S = np.linspace(0, 4000, 9)
    transfer = photon_transfer.Transfer(
        gain=5.0,
        read_noise=5.0,
        read_noise_interval=(4.9, 5.1),
        black=64.0,
        full_well=20_000.0,
        S=S,
        V=1 + S / 5,
        used=S < 3000,
    )
    line = sensors.transfer(transfer).lines[-1]
    x0, x1 = line.get_xdata()
    y0, y1 = line.get_ydata()
    assert (y1 - y0) / (x1 - x0) == pytest.approx(0.2)


def test_coverage_has_a_bar_for_each_photo_over_its_luminances():
    plan = planning.plan(0.1, 1000)
    ax = sensors.coverage(plan, 0.1, 1000)
    assert [tuple(line.get_xdata()) for line in ax.lines] == [tuple(held) for held in plan.holds]
    assert [text.get_text() for text in ax.texts] == [f"{name} s" for name in plan.names]


def test_bars_are_labeled_with_their_counts():
    ax = sensors.bars(ranges.levels_per_stop(8), across="stop", up="levels")
    assert [text.get_text() for text in ax.texts] == ["128", "64", "32", "16", "8", "4", "2", "1"]


def test_draw_titled_keeps_the_aspect_ratio_of_the_image():
    drawn = pictures.render(sensors.draw_titled(np.zeros((100, 200), np.uint8), "two\nlines"))
    assert drawn.shape[1] == 540 and drawn.shape[0] == pytest.approx(270 + 60, abs=3)


def test_sensor_plots_reject_arrays_of_different_shapes():
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
