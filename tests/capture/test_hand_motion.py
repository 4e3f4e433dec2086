"""`hand_motion` and `filters.warp`: simulated camera shake, and resampling that keeps energy."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from hdrlab import scenes
from hdrlab.align.shift import crop
from hdrlab.capture import camera, hand_motion
from hdrlab.core.filters import warp

SHAPE = (120, 170)


@pytest.fixture(scope="module")
def waves():
    """A scene without edges, known between its pixels: waves(x, y) -> radiance."""
    return lambda x, y: 2 + np.sin(x / 7 + y / 19) + 0.5 * np.cos(y / 6 - x / 23)


@pytest.fixture(scope="module")
def E(waves):
    y, x = np.indices(SHAPE)
    return waves(x, y).astype(np.float32)


MOVES = {
    "a fraction of a pixel": [[0.3, -4.6], [0, 0], [7.5, 2.25]],
    "a turn": [warp.turn(SHAPE, 3, (4.5, -2)), np.eye(3), warp.turn(SHAPE, -2)],
    "a step and a tilt": hand_motion.shake(3, SHAPE, degrees=2, zoom=0.05, tilt=0.05, rng=4),
}


@pytest.mark.papers
@pytest.mark.parametrize("name", MOVES)
def test_a_moved_camera_sees_the_scene_between_its_pixels(waves, E, name):
    moves = MOVES[name]
    seen = hand_motion.views(E, moves)
    own = hand_motion.frame_homographies(moves, SHAPE)
    y, x = np.indices(seen[0].shape)
    places = np.stack([x.ravel(), y.ravel()], axis=-1)
    first = best_corner(waves, seen[1])
    for view, H in zip(seen, own, strict=True):
        u, v = (warp.apply(H, places) + first).T
        off = np.abs(view.ravel() - waves(u, v))
        assert np.median(off) < 0.002 and off.max() < 0.02  # of steps to 0.2 a pixel


def best_corner(waves, still):
    """Return the (left, top) that fits a view best, by trying all positions without resampling."""
    y, x = np.indices(still.shape)
    tries = [(left, top) for left in range(40) for top in range(40)]
    return min(tries, key=lambda at: np.abs(still - waves(x + at[0], y + at[1])).max())


def test_shifts_written_as_homographies_cut_the_same_views_as_offsets(E):
    offsets = [[3, -4], [0, 0], [-6, 9]]
    for by_shift, by_homography in zip(
        hand_motion.views(E, offsets),
        hand_motion.views(E, warp.as_homographies(offsets)),
        strict=True,
    ):
        assert np.allclose(by_shift, by_homography, atol=1e-6)
    assert camera.views is hand_motion.views


def test_photos_of_a_rotating_camera_align_when_rotated_back():
    room = scenes.room((120, 170))
    moves = [warp.turn(room.shape, 2.5, (3, 5)), np.eye(3)]
    taken = camera.shoot(
        room, [1e-3, 1.001e-3], camera.Camera(response="linear", bits=16), offsets=moves
    )
    own = hand_motion.frame_homographies(moves, room.shape)
    rows, columns = warp.common_rectangle(own, taken.images.shape[1:3])
    still = taken.images[1][rows, columns].astype(float)
    first = warp.as_homographies([[rows.start, columns.start]])[0]
    turned = warp.sample(taken.images[0].astype(float), np.linalg.inv(own[0]) @ first, still.shape)
    off = np.abs(turned - taken.images[0][rows, columns])
    assert np.abs(turned - still).mean() < off.mean() / 4


def test_shake_is_reproducible_and_stays_within_its_limits():
    moves = hand_motion.shake(50, SHAPE, radius=5, degrees=2, zoom=0.1, rng=1)
    assert np.array_equal(moves, hand_motion.shake(50, SHAPE, radius=5, degrees=2, zoom=0.1, rng=1))
    assert np.array_equal(moves[25], np.eye(3))
    middle = (np.array(SHAPE[::-1]) - 1) / 2
    assert np.abs(warp.apply(moves, [middle])[:, 0] - middle).max() <= 5
    turned = np.rad2deg(np.arctan2(moves[:, 1, 0], moves[:, 0, 0]))
    grown = np.sqrt(np.linalg.det(moves[:, :2, :2]))
    assert 1.5 < np.abs(turned).max() <= 2 and 0.08 < np.abs(grown - 1).max() <= 0.1


def test_a_tilt_enlarges_one_side_and_leaves_the_middle():
    tilted = hand_motion.shake(50, SHAPE, radius=0, degrees=0, tilt=0.1, rng=1)
    middle = (np.array(SHAPE[::-1]) - 1) / 2
    assert np.allclose(warp.apply(tilted, [middle])[:, 0], middle)
    corners = warp.apply(tilted, warp.corners(SHAPE))
    right = corners[:, 2, 1] - corners[:, 1, 1]
    left = corners[:, 3, 1] - corners[:, 0, 1]
    assert 1.1 < (right / left).max() < 1.1 / 0.9 * 1.01
    assert 1.1 < (left / right).max() < 1.1 / 0.9 * 1.01


# warps


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=20)
def test_resampled_light_stays_between_the_light_around_it(seed):
    rng = np.random.default_rng(seed)
    E = 10.0 ** rng.uniform(-3, 4, (30, 40))
    H = warp.turn(E.shape, rng.uniform(-9, 9), rng.uniform(-1, 1, 2))
    resampled = warp.sample(E, H, E.shape)
    assert resampled.min() >= np.float32(E.min()) and resampled.max() <= np.float32(E.max())
    assert np.allclose(warp.sample(np.full((30, 40), 3.7), H, (20, 20)), 3.7)


def test_whole_pixels_are_not_resampled(E):
    H = warp.as_homographies([[2, 3]])[0]
    assert np.allclose(warp.sample(E, H, (50, 60)), E[2:52, 3:63], atol=1e-6)
    assert np.array_equal(warp.nearest(E, H, (50, 60)), E[2:52, 3:63])


@given(st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=1, max_size=5))
def test_of_shifted_pictures_the_rectangle_is_the_crop(offsets):
    rows, columns = warp.common_rectangle(offsets, (30, 40))
    kept = crop([*offsets, (0, 0)], (30, 40))
    with_first = warp.common_rectangle([*offsets, (0, 0)], (30, 40))
    assert with_first == kept and rows.stop - rows.start >= kept[0].stop - kept[0].start


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=25)
def test_the_common_rectangle_lies_in_every_image_and_touches_their_sides(seed):
    moves = hand_motion.shake(3, SHAPE, radius=9, degrees=5, zoom=0.05, tilt=0.03, rng=seed)
    rows, columns = warp.common_rectangle(moves, SHAPE)

    def beyond(grow):
        box = np.array([[x, y] for x in columns_of(grow[:2]) for y in rows_of(grow[2:])])
        back = warp.apply(np.linalg.inv(moves), box)
        return max(
            float(-back.min()), float((back - (SHAPE[1] - 1, SHAPE[0] - 1)).max(axis=(0, 1)).max())
        )

    def columns_of(grow):
        return columns.start - grow[0], columns.stop - 1 + grow[1]

    def rows_of(grow):
        return rows.start - grow[0], rows.stop - 1 + grow[1]

    assert beyond((0, 0, 0, 0)) < 0.01
    for side in np.eye(4, dtype=int):
        assert beyond(side) > 0


def test_corner_distance_is_that_of_the_worst_corner():
    assert warp.corner_distance(warp.as_homographies([[3, 4]]), np.eye(3), SHAPE) == pytest.approx(
        [5]
    )
    half = np.hypot(119, 169) / 2
    assert warp.corner_distance(warp.turn(SHAPE, 1), np.eye(3), SHAPE) == pytest.approx(
        half * np.pi / 180, rel=1e-3
    )


@pytest.mark.parametrize(
    ("moves", "message"),
    [
        ([[0, 0, 0]], "expected finite homographies"),
        ([[np.nan, 0]], "expected finite homographies"),
        ([], "expected finite homographies"),
        ([["a", "b"]], "expected finite homographies"),
        (np.zeros((2, 3, 3)), "without an inverse"),
        (np.ones((1, 3, 4)), "expected finite homographies"),
        ([[[1, 0, 0], [0, 1, 0], [-0.02, 0, 1]]], "in front of the camera"),
        ([[0, 0], [0, 500]], "with which the images overlap"),
    ],
)
def test_invalid_homographies_raise_an_error(moves, message):
    with pytest.raises(ValueError, match=message):
        warp.common_rectangle(moves, SHAPE)


@pytest.mark.parametrize(
    "knobs", [dict(count=0), dict(radius=-1), dict(degrees=np.nan), dict(tilt=0.5)]
)
def test_invalid_shake_parameters_raise_an_error(knobs):
    with pytest.raises(ValueError, match="frame, motion"):
        hand_motion.shake(**{"count": 3, "shape": SHAPE} | knobs)
