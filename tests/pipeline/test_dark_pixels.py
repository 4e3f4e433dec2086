"""Pixels that are black in every photo have no color; measured pixels keep theirs."""

import numpy as np
import pytest

from hdrlab.capture import camera
from hdrlab.capture.responses import true_g
from hdrlab.core.bracket import bracket
from hdrlab.io.photos import read_bracket
from hdrlab.pipeline import dark_pixels, stages

BLACK = np.s_[:, 130:180]
RED = np.s_[10:50, 70:110]


def photograph_night(*, longest_factor=1.0):
    """Return photos of a night with a lamp ramp, a red wall and a black sky of blue noise."""
    E = np.empty((120, 180, 3), np.float32)
    ramp = np.geomspace(0.02, 4, 60)[None, :, None]
    E[:, :60] = ramp
    E[:, 60:120] = 0.05
    E[10:50, 70:110] = [0.06, 0.015, 0.015]
    E[:, 120:] = 2e-5
    times = np.array([0.03, 0.12, 0.5, 2]) * longest_factor
    noisy = camera.Camera(response="gamma", full_well=20000, read_noise=4)
    taken = camera.shoot(E, times, noisy, rng=1)
    images = taken.images.astype(int)
    is_dark = images.max(axis=-1, keepdims=True) < 4
    images = images + np.where(is_dark, [0, 0, 2], 0)
    images = np.clip(images, 0, 255).astype(np.uint8)
    return bracket(images, times)


def measure_log_ratios(E):
    """Return the typical log2 of red and blue over green."""
    return np.median(np.log2(E[..., [0, 2]] / E[..., [1]]), axis=(0, 1))


def test_black_of_every_frame_is_gray_with_a_warning():
    assembly = stages.assemble(photograph_night(), align="none")
    assert np.abs(measure_log_ratios(assembly.E[BLACK])).max() < 0.15
    assert assembly.warnings


def test_dark_red_that_a_frame_measures_stays_red():
    assembly = stages.assemble(photograph_night(), align="none")
    red_over_green, _ = measure_log_ratios(assembly.E[RED])
    assert abs(red_over_green - 2) < 0.2


def test_well_measured_dark_pixels_bring_no_warning_and_no_change():
    night = photograph_night()
    bright = night.images[:, :, :120]
    assert stages.assemble(bracket(bright, night.times), align="none").warnings == ()
    assert dark_pixels.measure_color_certainty(bright, night.times) is None


def test_a_dark_16_bit_photo_above_its_noise_keeps_its_color():
    rng = np.random.default_rng(1)
    images = np.full((2, 20, 30, 3), [600, 150, 150]) + rng.integers(-9, 10, (2, 20, 30, 3))
    assert dark_pixels.measure_color_certainty(images.astype(np.uint16), [1, 2]) is None


def test_pixels_that_another_photo_measures_keep_their_color():
    images = np.full((2, 20, 20, 3), 1, np.uint8)
    images[0, 5:15, 5:15] = [150, 20, 20]
    certainty = dark_pixels.measure_color_certainty(images, [1, 2])
    assert np.all(certainty[5:15, 5:15] == 1)
    assert certainty[0, 0] == 0


# white balance of gray photos that is a little blue
CAST = np.array([0.9, 1, 1.05])


def measure_ratios_by_tone(E):
    """Return log2 of red and blue over green in ten parts of a map, from dark to bright, (10, 2)."""
    light = E.mean(axis=-1)
    edges = np.quantile(light, np.linspace(0, 1, 11))
    return np.array(
        [
            measure_log_ratios(E[(light >= low) & (light <= high)][None])
            for low, high in zip(edges[:-1], edges[1:], strict=True)
        ]
    )


def test_gray_photos_with_a_color_cast_have_it_in_every_tone():
    ramp = np.geomspace(2e-4, 1, 300)[None, :, None]
    E = (ramp * CAST * np.ones((200, 1, 1))).astype(np.float32)
    sensor = camera.Camera(response="srgb", full_well=20_000, read_noise=8)
    taken = camera.shoot(E, 2.0 ** np.arange(-6, 1), sensor, rng=1)
    assembly = stages.assemble(taken, align="none")
    errors = measure_ratios_by_tone(assembly.E) - np.log2(CAST[[0, 2]])
    assert np.abs(errors).max() < 0.1


def test_black_stays_neutral_next_to_many_colors():
    assembly = stages.assemble(photograph_night(), align="none")
    assert np.abs(np.log2(assembly.E[BLACK] / assembly.E[BLACK][..., :1])).max() < 0.3
    colors = np.random.default_rng(1).uniform(0.1, 1, (20, 20, 3))
    neutral = dark_pixels.measure_neutral(colors, np.ones((20, 20)))
    assert neutral == pytest.approx(1)


def test_the_gray_case_has_the_color_of_its_photos_in_every_tone(shared):
    folder = shared("cases") / "gray_dark"
    taken = read_bracket(sorted(folder.glob("*.jpg")))
    # The photos are sRGB, so what a well exposed pixel of them shows does not need the response.
    well_exposed = taken.images[-1][
        np.all(np.abs(taken.images[-1].astype(int) - 140) < 60, axis=-1)
    ]
    exposures = np.exp(true_g("srgb"))[well_exposed]
    photo_ratios = measure_log_ratios(exposures[None])
    assembly = stages.assemble(taken)
    assert np.abs(measure_ratios_by_tone(assembly.E) - photo_ratios).max() < 0.1


def test_a_large_map_fades_in_place_as_a_small_one_does():
    rng = np.random.default_rng(1)
    E = rng.uniform(0.1, 1, (900, 800, 3)).astype(np.float32)
    certainty = np.ones(E.shape[:2], np.float32)  # the middle of the map has all of its color
    certainty[:9] = rng.uniform(0, 1, (9, 800))
    certainty[-9:] = 0
    ends = np.concatenate([E[:9], E[-9:]])
    expected = E.copy()
    faded_ends = dark_pixels.fade_to_neutral(ends, np.concatenate([certainty[:9], certainty[-9:]]))
    expected[:9] = faded_ends[:9]
    expected[-9:] = faded_ends[9:]
    kept = E.copy()
    assert np.allclose(dark_pixels.fade_to_neutral(E, certainty), expected, rtol=1e-6)
    assert np.array_equal(E, kept)
    dark_pixels.fade_to_neutral(E, certainty, in_place=True)
    assert np.allclose(E, expected, rtol=1e-6)


def test_the_noise_of_a_large_photo_is_its_standard_deviation():
    rng = np.random.default_rng(3)
    level = 8 * 257
    deviation = 1.2 * 257
    photo = rng.normal(level, deviation, (1200, 1000)).astype(np.uint16)
    assert dark_pixels.measure_noise(photo) == pytest.approx(deviation, rel=0.01)
