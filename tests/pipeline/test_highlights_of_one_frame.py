"""A photo that is the only one to show a lamp is not dropped."""

from dataclasses import replace

import numpy as np
import pytest

from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.pipeline import stages

LAMP = np.s_[51:53, 61:63]


def photograph_lamp(*, middle, lamp):
    """Return a room whose lamp of 4 x 4 pixels is `lamp` times as bright as the rest, and photos."""
    room = scenes.room((240, 360))
    E = np.minimum(room, np.quantile(room, 0.97)).astype(np.float32)
    E[50:54, 60:64] = E.max() * lamp
    times = camera.times_around(E, 7, stops=2, middle=middle)
    noisy = camera.Camera(response="film", full_well=5000, read_noise=15)
    return E, camera.shoot(E, times, noisy, rng=1)


def measure_lamp_error(E, assembly):
    """Return the error of the contrast between the lamp and the median, in stops."""
    ratio = np.median(assembly.E[LAMP]) / np.median(assembly.E)
    true = np.median(E[LAMP]) / np.median(E)
    return abs(np.log2(ratio / true))


@pytest.mark.parametrize("floor", [0, 8])
def test_a_black_frame_that_only_a_lamp_needs_stays_without_a_warning(floor):
    E, bracket = photograph_lamp(middle=0.02, lamp=20)
    images = bracket.images.copy()
    images[0] = np.maximum(images[0], floor)
    assembly = stages.assemble(replace(bracket, images=images), align="none")
    assert len(assembly.bracket.times) == 7
    assert assembly.warnings == ()
    assert measure_lamp_error(E, assembly) < 0.3


@pytest.mark.parametrize(("middle", "lamp"), [(0.2, 4), (0.05, 10)])
def test_the_only_frame_of_a_lamp_stays_and_its_wrong_time_is_corrected(middle, lamp):
    E, bracket = photograph_lamp(middle=middle, lamp=lamp)
    wrong_times = bracket.times * [2, 1, 1, 1, 1, 1, 1]
    assembly = stages.assemble(replace(bracket, times=wrong_times), align="none")
    assert len(assembly.bracket.times) == 7
    assert assembly.warnings
    assert measure_lamp_error(E, assembly) < 0.2


def test_a_stated_time_is_not_corrected_and_its_frame_stays():
    _, bracket = photograph_lamp(middle=0.2, lamp=4)
    wrong_times = bracket.times * [2, 1, 1, 1, 1, 1, 1]
    wrong = replace(bracket, times=wrong_times)
    assembly = stages.assemble(wrong, align="none", times="stated")
    assert np.array_equal(assembly.bracket.times, wrong_times)
    assert assembly.warnings


def test_the_shortest_frame_of_another_scene_is_left_out():
    _, bracket = photograph_lamp(middle=0.2, lamp=4)
    images = bracket.images.copy()
    images[0] = np.flip(images[0], axis=(0, 1))
    assembly = stages.assemble(replace(bracket, images=images), align="none")
    assert len(assembly.bracket.times) == 6
