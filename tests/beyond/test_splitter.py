"""One lens and three sensors: closed forms of the merging rules, and scenes with a known truth."""

import numpy as np
import pytest

from hdrlab.beyond import splitter
from hdrlab.capture import camera, movers
from hdrlab.core.colour import luminance
from hdrlab.core.filters import mosaic
from hdrlab.errors import InputError
from hdrlab.fast.merge import merge
from hdrlab.scenes.places import layers

E_SHARES = splitter.shares()
WELL = {"full_well": 20000, "read_noise": 5}


def test_the_beam_splitters_only_lose_the_light_reflected_to_the_lens():
    e = splitter.shares((0.08, 0.06))
    assert 1 - e.sum() == pytest.approx(0.08 * 0.06 * 0.08)
    assert np.log2(e[0] / e[1]) == pytest.approx(3.6, abs=0.05)
    assert np.log2(e[1] / e[2]) == pytest.approx(4.1, abs=0.05)


def test_each_pixel_is_blended_by_the_case_of_its_neighborhood():
    B = np.full((15, 15), 0.5)
    D = np.full((15, 15), 0.7)
    full = np.zeros((15, 15), bool)
    full[4:11, 4:11] = True
    E, case = splitter.join_sensors(B, D, full)
    assert case[0, 0] == 1 and E[0, 0] == 0.5
    assert case[3, 7] == 2
    assert E[3, 7] == pytest.approx(0.6 * 0.5 + 0.4 * 0.7)  # two rows of five are full
    assert case[4, 7] == 3
    assert E[4, 7] == pytest.approx(0.4 * 0.5 + 0.6 * 0.7)  # B is predicted, 0.5
    assert case[7, 7] == 4 and E[7, 7] == 0.7


def test_a_full_pixel_is_predicted_by_the_ratio_of_its_neighbors():
    D = np.linspace(1, 2, 100).reshape(10, 10)
    full = np.zeros((10, 10), bool)
    full[5, 5] = True
    assert splitter.predict_full(1.1 * D, D, full)[5, 5] == pytest.approx(1.1 * D[5, 5])


def test_a_ramp_over_six_decades_is_reconstructed_and_rises():
    E = np.geomspace(1e-3, 200, 600) * np.ones((32, 1))
    back = splitter.merge(splitter.shoot(E, E_SHARES, **WELL, bits=16), E_SHARES)
    seen = np.median(back, axis=0)[E[0] > 0.02]
    assert np.abs(back[:, E[0] > 0.02].mean(axis=0) / E[0][E[0] > 0.02] - 1).max() < 0.03
    assert np.all(np.diff(seen[::10]) > 0)


def test_the_seams_are_smaller_than_those_of_a_hard_threshold():
    """Two sensors whose ratio is off by 5 %: without the neighbourhood there would be a step of 5 %."""
    E = np.linspace(0.8, 1.2, 400) * np.ones((20, 1))
    Z = splitter.shoot(E, E_SHARES, bits=16)
    wrong = E_SHARES * [1, 0.95, 1]
    back = splitter.merge(Z, wrong)[10] / E[10]
    X = Z[0, 10] / 65535
    hard = np.where(X < splitter.CLIPPING_LEVEL, X / wrong[0], Z[1, 10] / 65535 / wrong[1]) / E[10]
    assert np.abs(np.diff(hard)).max() > 0.045 > 2 * np.abs(np.diff(back)).max()


def test_a_well_exposed_pixel_is_the_brightest_sensors_alone():
    """Its noise is not mixed with that of the others."""
    E = np.full((64, 64), 0.5)
    Z = splitter.shoot(E, E_SHARES, **WELL)
    assert np.array_equal(splitter.merge(Z, E_SHARES), np.float32(Z[0] / 65535 / E_SHARES[0]))


def test_a_moving_scene_leaves_no_ghost_where_a_bracket_does():
    """Three sensors at one moment, compared with three photos one after another with the same fractions
    of light.
    """
    street = layers("street", (64, 96))
    room = luminance(street.radiance) / 8
    figure = movers.Figure(luminance(street.mover) / 8, street.mask)
    linear = camera.Camera(response="linear", bits=16, **WELL)
    taken = movers.shoot(room, figure, [[0, -5], [0, 5], [0, 15]], E_SHARES[::-1], linear)
    truth = taken.moments[1]
    back = splitter.merge(splitter.shoot(truth, E_SHARES, **WELL), E_SHARES)
    g = np.log(np.maximum(np.arange(65536), 0.5) / 32768)
    bracket = merge(taken.bracket.images, taken.bracket.times, g) * 32768 / 65535
    there = taken.region & (truth > 0.01)
    ours = np.sqrt(np.mean(np.log2(np.maximum(back, 1e-3) / truth)[there] ** 2))
    theirs = np.sqrt(np.mean(np.log2(np.maximum(bracket, 1e-3) / truth)[there] ** 2))
    assert ours < 0.1 and theirs > 5 * ours


def test_a_mosaic_is_merged_before_its_colours_are_interpolated():
    E = np.array([4.0, 1.0, 0.25]) * np.ones((16, 16, 1))
    c = mosaic.tile(mosaic.BAYER, E.shape[:2])
    assert np.allclose(splitter.merge(splitter.shoot(E, E_SHARES, c), E_SHARES, c), E, rtol=0.01)


def test_the_steps_add_the_sensors_from_the_darkest_to_the_brightest():
    Z = splitter.shoot(np.geomspace(0.01, 100, 400).reshape(20, 20), E_SHARES)
    steps = list(splitter.merge_steps(Z, E_SHARES))
    assert [state.sensor for state in steps] == [2, 1, 0]
    assert set(np.unique(steps[-1].case)) == {
        1,
        2,
        3,
        4,
    }
    assert np.array_equal(steps[-1].E.astype(np.float32), splitter.merge(Z, E_SHARES))


def test_pixels_that_are_full_on_all_sensors_get_the_lower_bound():
    E = np.full((8, 8), 1e4)
    assert np.allclose(
        splitter.merge(splitter.shoot(E, E_SHARES), E_SHARES), 1 / E_SHARES[-1], rtol=1e-3
    )


@pytest.mark.parametrize(
    "call",
    [
        lambda: splitter.as_shares([0.1, 0.9]),
        lambda: splitter.as_shares([0.9, 0.9]),
        lambda: splitter.as_shares([]),
        lambda: splitter.as_shares([0.5, np.nan]),
        lambda: splitter.merge(np.zeros((2, 4, 4), np.uint8), E_SHARES),
        lambda: splitter.merge(np.zeros((3, 4, 4)), E_SHARES),
        lambda: splitter.merge(np.zeros((3, 4, 4), np.uint8), E_SHARES, full=0),
        lambda: splitter.merge(np.zeros((3, 4, 4), np.uint8), E_SHARES, np.zeros((3, 3), int)),
        lambda: splitter.shoot(np.ones((4, 4)), E_SHARES, bits=20),
        lambda: splitter.shoot(-np.ones((4, 4)), E_SHARES),
    ],
)
def test_invalid_arguments_raise_an_error(call):
    with pytest.raises(InputError):
        call()


def test_a_pixel_exactly_at_the_full_level_counts_as_full():
    """Light in the last level of the brightest sensor has no upper bound, so the next sensor decides."""
    Z = np.full((3, 9, 9), 40, np.uint8)
    Z[2, 4, 4] = 255
    *_, last = splitter.merge_steps(Z[::-1], [0.9, 0.07, 0.004], full=1.0)
    assert last.case[4, 4] == 3 and last.case[0, 0] == 1
