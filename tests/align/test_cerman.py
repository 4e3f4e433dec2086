"""`align.cerman`: shift and rotation to a fraction of a pixel."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from hdrlab import scenes
from hdrlab.align import cerman, light, mtb
from hdrlab.capture import camera, hand_motion
from hdrlab.capture.responses import true_g
from hdrlab.core.arrays import levels
from hdrlab.core.filters import warp
from hdrlab.errors import InputError

pytestmark = pytest.mark.papers

SHAPE = (110, 160)


@pytest.fixture(scope="module")
def room():
    return scenes.room(SHAPE)


def shoot(E, moves, *, stops=2.0, response="film", bits=8, rng=1, count=None):
    """Return photographs of a moved camera, and the moves in their own pixels."""
    times = camera.times_around(E, count or len(moves), stops=stops)
    model = camera.Camera(response=response, bits=bits, full_well=20_000, read_noise=5)
    taken = camera.shoot(E, times, model, offsets=moves, rng=rng)
    return taken, hand_motion.frame_homographies(moves, E.shape)


def off(homographies, truth, shape=SHAPE):
    """Return the worst error of moves at the corners, pixels, relative to the last frame."""
    ours = np.linalg.inv(homographies[-1]) @ homographies
    theirs = np.linalg.inv(truth[-1]) @ truth
    return float(warp.corner_distance(ours, theirs, shape).max())


# light


@pytest.mark.parametrize("response", ["film", "srgb", "linear"])
def test_two_exposures_come_to_one_scale(room, response):
    taken = camera.shoot(
        room, camera.times_around(room, 2, stops=2), camera.Camera(response=response)
    )
    dark, bright = taken.images[..., 1]
    exposures = np.exp(true_g(response))
    X = light.pair(bright, dark, exposures, 4.0 * exposures)[0]
    kept = np.isfinite(X).all(axis=0)
    assert kept.mean() > 0.3
    assert np.median(np.abs(X[0][kept] / X[1][kept] - 1)) < 0.03


@pytest.mark.parametrize("response", ["film", "srgb"])
def test_without_times_the_exposure_ratio_is_estimated_from_histograms(room, response):
    times = camera.times_around(room, 2, stops=1.5)
    dark, bright = camera.shoot(
        room, times, camera.Camera(response=response), offsets=[[4, -6], [0, 0]]
    ).images[..., 1]
    assert light.exposure_ratio(dark, bright, true_g(response)) == pytest.approx(
        times[1] / times[0], rel=0.06
    )


def test_pixels_that_one_photo_does_not_measure_are_discarded_in_both(room):
    taken = camera.shoot(room, camera.times_around(room, 2, stops=3))
    dark, bright = taken.images[..., 1]
    exposures = np.exp(true_g())
    X = light.pair(bright, dark, exposures, 8.0 * exposures)[0]
    assert np.all(np.isnan(X[0][bright > 250])) and np.all(np.isnan(X[1][dark < 5]))
    low = np.float32(8.0 * exposures[5])
    high = np.float32(exposures[250])
    for x, Z, k in zip(X, (bright, dark), (1.0, 8.0), strict=True):
        light_ = (k * exposures).astype(np.float32)[Z]
        assert np.array_equal(np.isfinite(x), (light_ > low) & (light_ < high))


# correlation and error


@given(st.integers(-20, 20), st.integers(-30, 30), st.integers(0, 99))
@settings(max_examples=15)
def test_the_highest_peak_is_the_shift(dy, dx, seed):
    noise = np.random.default_rng(seed).uniform(0.5, 2, (120, 160)).astype(np.float32)
    X = np.stack([noise[30:90, 40:120], noise[30 + dy : 90 + dy, 40 + dx : 120 + dx]])
    assert cerman.peaks(cerman.correlation(X), 1).tolist() == [[dy, dx]]


def test_the_error_is_zero_for_equal_light_and_does_not_depend_on_its_unit(room):
    L = room[..., 1] + np.float32(0.01)
    X = np.stack([L, L])
    p = light.lattice(SHAPE)
    assert light.error(light.differences(X, np.eye(3), p)) == 0
    moved = warp.as_homographies([[1, 2]])[0]
    e = [light.error(light.differences(X * k, moved, p)) for k in np.float32([1, 100])]
    assert e[0] == pytest.approx(e[1], rel=1e-4) and e[0] > 0


def test_the_error_is_the_mean_square_of_the_normalised_difference():
    a, b = np.random.default_rng(0).uniform(1, 3, (2, 40, 50)).astype(np.float32)
    p = light.lattice((40, 50), 10**6)
    expected = np.mean(((a - b) / ((a + b) / 2)) ** 2)
    assert light.error(light.differences(np.stack([a, b]), np.eye(3), p)) == pytest.approx(
        expected, rel=1e-4
    )


# the search, step by step


def test_a_pair_is_searched_from_coarse_to_fine_and_the_error_falls_along_each_path(room):
    taken, truth = shoot(room, [warp.turn(SHAPE, 2, (6.3, -8.4)), np.eye(3)])
    states = list(cerman.align_steps(taken.images, taken.times, true_g()))
    assert [state.level for state in states] == list(range(len(states)))[::-1]
    for state in states:
        assert state.errors[-1] <= state.errors[0] and np.all(np.diff(state.errors) <= 1e-12)
        assert state.path.shape == (len(state.errors), 3)
        assert np.allclose(cerman.rigid(state.X.shape[1:], state.path[-1]), state.H)
    assert warp.corner_distance(states[-1].H, truth[0], SHAPE) < 0.3


def test_changing_a_yielded_state_does_not_change_the_search(room):
    taken, _ = shoot(room, [warp.turn(SHAPE, 1, (3, 2)), np.eye(3)])
    for state in cerman.align_steps(taken.images, taken.times, true_g()):
        last = state.H.copy()
        for array in (state.X, state.path, state.errors, state.H):
            array[:] = 0
    assert np.allclose(last, list(cerman.align_steps(taken.images, taken.times, true_g()))[-1].H)


# known moves


@pytest.mark.parametrize(
    ("degrees", "offset"), [(0, (0.4, -0.7)), (3, (9.6, -11.2)), (-2.4, (-12, 8.5)), (8, (0, 0))]
)
def test_shift_and_rotation_are_found_to_a_third_of_a_pixel_at_the_corners(degrees, offset):
    E = scenes.room((150, 220))
    taken, truth = shoot(E, [warp.turn(E.shape, degrees, offset), np.eye(3)])
    assert off(cerman.align(taken.images, taken.times, true_g()), truth, E.shape) < 0.3


@pytest.mark.parametrize("bits", [8, 16])
@pytest.mark.parametrize("colours", ["gray", "colour"])
def test_gray_and_colour_8_and_16_bits(room, bits, colours):
    E = room if colours == "colour" else room[..., 1]
    taken, truth = shoot(E, [warp.turn(SHAPE, -1.2, (3.3, 4.4)), np.eye(3)], bits=bits)
    g = true_g("film", levels(taken.images))
    assert off(cerman.align(taken.images, taken.times, g), truth) < 0.3


def test_four_frames_are_aligned_to_the_middle_one(room):
    moves = hand_motion.shake(4, SHAPE, radius=6, degrees=1.5, rng=3)
    taken, truth = shoot(room, moves)
    homographies = cerman.align(taken.images, taken.times, true_g())
    assert np.array_equal(homographies[2], np.eye(3))
    assert off(np.roll(homographies, -3, axis=0), np.roll(truth, -3, axis=0)) < 0.5


def test_the_order_of_frames_does_not_change_their_homographies(room):
    taken, _ = shoot(room, hand_motion.shake(3, SHAPE, radius=5, degrees=1, rng=2))
    order = [2, 0, 1]
    homographies = cerman.align(taken.images, taken.times, true_g())
    other = cerman.align(taken.images[order], taken.times[order], true_g())
    assert np.allclose(other, homographies[order])


def test_frames_from_a_tripod_are_not_moved(room):
    taken, _ = shoot(room, np.tile(np.eye(3), (2, 1, 1)))
    homographies = cerman.align(taken.images, taken.times, true_g())
    assert np.all(warp.corner_distance(homographies, np.eye(3), SHAPE) < 0.1)


def test_a_single_frame_is_not_moved(room):
    taken, _ = shoot(room, [np.eye(3)])
    assert np.array_equal(cerman.align(taken.images, taken.times, true_g()), [np.eye(3)])


@pytest.mark.parametrize("shape", [(1, 1), (1, 300), (10, 10), (33, 63)])
def test_small_frames_are_aligned_without_an_error(shape):
    images = np.random.default_rng(0).integers(0, 256, (3, *shape), dtype=np.uint8)
    assert cerman.align(images, [1, 2, 4], true_g()).shape == (3, 3, 3)


@pytest.mark.parametrize(
    ("images", "times"),
    [
        (np.zeros((2, 8, 8)), [1, 2]),
        (np.zeros((8, 8), np.uint8), [1, 2]),
        (np.zeros((2, 8, 8), np.uint8), [1]),
    ],
)
def test_invalid_images_and_times_raise_an_error(images, times):
    for verb in (cerman.align, lambda *arguments: list(cerman.align_steps(*arguments))):
        with pytest.raises(InputError):
            verb(images, times, true_g())


def test_a_pair_without_a_result_does_not_break_the_chain_of_homographies():
    steps = [*warp.as_homographies([(1.5, 2), (10, 20.25), (100, 0)])]
    order = [3, 0, 2, 1]

    def offsets():
        return warp.chain_homographies(order, steps)[:, 1::-1, 2]

    assert np.allclose(offsets(), [(10, 20.25), (-100, 0), (0, 0), (11.5, 22.25)])
    steps[1] = np.eye(3)
    assert np.allclose(offsets(), [(0, 0), (-100, 0), (0, 0), (1.5, 2)])


def test_for_pure_shifts_cerman_agrees_with_mtb(room):
    taken, _ = shoot(room, [[5, -8], [0, 0]])
    moves = cerman.align(taken.images, taken.times, true_g())
    assert np.abs(moves[:, :2, 2][:, ::-1] - mtb.align(taken.images)).max() < 0.3
