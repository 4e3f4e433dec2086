"""Simulated brackets with moving objects: each photo and the true radiance map."""

import numpy as np
import pytest

from hdrlab import scenes
from hdrlab.capture import camera, movers
from hdrlab.errors import InputError

WALL = np.full((40, 60, 3), 0.5, np.float32)
BALL = movers.ball((40, 60), (20, 30), 8, [2.0, 1.0, 0.5])
TIMES = [0.125, 0.5, 2.0]


def test_compose_moment_puts_the_figure_in_front_of_the_scene():
    E, mask = movers.compose_moment(WALL, BALL, (3, -10))
    assert np.array_equal(E[mask == 0], WALL[mask == 0])
    assert np.allclose(E[mask == 1], shifted(BALL.light)[mask == 1])
    assert np.allclose(E, shifted(BALL.light) + (1 - shifted(BALL.mask)[..., None]) * WALL)


def shifted(layer):
    """Return a layer moved 3 down and 10 to the left by np.roll; the ball is far from every edge."""
    return np.roll(layer, (3, -10), axis=(0, 1))


def test_a_ball_has_the_area_of_its_disc_and_its_radiance_at_the_brightest():
    plain = movers.ball((80, 80), (40, 40), 20, 3.0, stripes=0)
    assert plain.mask.sum() == pytest.approx(np.pi * 20**2, rel=0.01)
    assert plain.light.max() == pytest.approx(3.0, rel=0.02)
    assert np.all(plain.light <= 3 * plain.mask) and np.all(plain.light[plain.mask == 1] > 0)


def test_a_figure_that_leaves_the_frame_does_not_wrap_around():
    for at in [(0, 200), (-90, 0), (39, 59), (-40, -60)]:
        E, mask = movers.compose_moment(WALL, BALL, at)
        assert np.array_equal(E[mask == 0], WALL[mask == 0]) and mask.sum() < BALL.mask.sum() / 4


def test_each_photo_shows_its_moment_and_the_truth_is_sorted_alike():
    taken = movers.shoot(
        WALL, BALL, movers.path(3, (0, 12)), TIMES[::-1], camera.Camera(response="linear")
    )
    assert taken.bracket.times.tolist() == TIMES and taken.bracket.linear
    for image, seen, t in zip(taken.bracket.images, taken.moments, TIMES, strict=True):
        assert np.array_equal(
            image, camera.shoot(seen, t, camera.Camera(response="linear")).images[0]
        )
    left = [np.flatnonzero(mask.any(axis=0))[0] for mask in taken.hidden]
    assert np.diff(left).tolist() == [-12, -12]  # the longest exposure was given first


def test_outside_the_region_every_moment_is_the_still_scene():
    taken = movers.shoot(WALL, BALL, movers.path(3, (4, 9)), TIMES)
    assert np.array_equal(taken.still, WALL)
    assert np.all(taken.moments[:, ~taken.region] == WALL[~taken.region])
    assert all(np.any(moment != WALL) for moment in taken.moments)


def test_photos_of_equal_times_keep_their_own_truth():
    taken = movers.shoot(
        WALL, BALL, movers.path(4, (0, 9)), [1.0] * 4, camera.Camera(response="linear")
    )
    for image, seen in zip(taken.bracket.images, taken.moments, strict=True):
        assert np.array_equal(
            image, camera.shoot(seen, 1.0, camera.Camera(response="linear")).images[0]
        )


def test_camera_shake_moves_scene_and_figure_together():
    offsets = np.array([[2, 0], [0, 0], [-3, 5]])
    wall = np.random.default_rng(1).random((40, 60, 3), np.float32)
    taken = movers.shoot(wall, BALL, np.zeros((3, 2), int), TIMES, offsets=offsets)
    E, _ = movers.compose_moment(wall, BALL, (0, 0))
    for seen, view in zip(taken.moments, camera.views(E, offsets), strict=True):
        assert np.array_equal(seen, view)
    assert np.array_equal(taken.still, camera.views(wall, offsets)[1])


def test_the_visitor_of_an_embedded_place_is_a_figure():
    place = scenes.layers("street", (64, 96))
    E, _ = movers.compose_moment(place.radiance, movers.Figure(place.mover, place.mask), (0, 7))
    assert np.allclose(E, scenes.compose(place, (0, 7)))


def test_a_path_has_equal_steps_and_is_centered_on_the_middle_frame():
    at = movers.path(5, (2, -10))
    assert at[2].tolist() == [0, 0] and np.all(np.diff(at, axis=0) == [2, -10])


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"figure": movers.Figure(BALL.light[:9], BALL.mask)}, "light"),
        ({"figure": movers.Figure(BALL.light, 2 * BALL.mask)}, "mask from 0 to 1"),
        ({"at": [(0, 0)]}, "places"),
        ({"at": np.zeros((3, 2))}, "whole pixels"),
        ({"offsets": [[1, 1], [2, 2], [3, 3]]}, r"at \(0, 0\)"),
        ({"times": [0, 1, 2]}, "positive exposure times"),
        ({"model": camera.Camera(hot=0.01)}, "hot"),
    ],
)
def test_invalid_figures_and_places_raise_an_error(wrong, message):
    arguments = {"E": WALL, "figure": BALL, "at": movers.path(3, (0, 9)), "times": TIMES} | wrong
    with pytest.raises(ValueError, match=message):
        movers.shoot(**arguments)


@pytest.mark.parametrize(
    "wrong", [{"radius": 0}, {"radiance": [1, 2]}, {"radiance": -1}, {"centre": 3}]
)
def test_an_invalid_ball_raises_an_error(wrong):
    with pytest.raises(InputError):
        movers.ball(**({"shape": (20, 20), "centre": (9, 9), "radius": 4} | wrong))
