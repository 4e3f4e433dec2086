"""Homographies and resampling: closed forms."""

import numpy as np
import pytest

from hdrlab.core.filters import warp
from hdrlab.errors import InputError

TILTED = np.array([[1.02, 0.03, -0.4], [-0.02, 0.98, 0.7], [1e-3, -2e-3, 1]])
PICTURE = np.random.default_rng(1).random((9, 12)).astype(np.float32)


def test_an_offset_moves_points_down_and_to_the_right():
    H = warp.as_homographies([[3, -1]])[0]
    assert np.allclose(warp.apply(H, [[10, 20]]), [[9, 23]])  # (x, y)


def test_a_homography_is_the_same_up_to_a_factor():
    assert np.allclose(warp.as_homographies([7 * TILTED]), [TILTED])


def test_a_quarter_turn_takes_the_top_left_corner_to_the_top_right():
    H = warp.turn((21, 21), 90)
    assert np.allclose(warp.apply(H, warp.corners((21, 21))), [[20, 0], [20, 20], [0, 20], [0, 0]])


def test_scale_enlarges_about_the_middle_and_the_offset_is_added():
    H = warp.turn((11, 21), 0, (1.5, -2), scale=2)
    assert np.allclose(warp.apply(H, [[10, 5], [11, 5]]), [[8, 6.5], [10, 6.5]])


def test_chained_steps_end_on_the_middle_image():
    steps = [TILTED, warp.turn((20, 30), 3, (1, -2)), TILTED.T]
    order = [3, 1, 0, 2]
    H = warp.chain_homographies(order, steps)
    assert np.allclose(H[order[2]], np.eye(3))
    points = warp.corners((20, 30))
    for step, moving, fixed in zip(steps, order, order[1:], strict=False):
        here = warp.apply(H[moving], points)
        assert np.allclose(here, warp.apply(H[fixed], warp.apply(step, points)))


def test_a_shift_by_whole_pixels_samples_the_pixels_themselves():
    H = warp.as_homographies([[2, 3]])[0]
    for resample in (warp.sample, warp.nearest):
        assert np.allclose(resample(PICTURE, H, (7, 9)), PICTURE[2:, 3:], atol=1e-6)


def test_cubic_interpolation_keeps_a_ramp_inside():
    y, x = np.indices((12, 15))
    moved = warp.sample(2 * x + 3 * y, warp.as_homographies([[0.25, 0.5]])[0], (12, 15))
    expected = 2 * (x + 0.5) + 3 * (y + 0.25)
    assert np.allclose(moved[2:-3, 2:-3], expected[2:-3, 2:-3], atol=1e-4)


def test_a_sample_stays_between_the_four_pixels_around_it():
    lamp = np.zeros((9, 9), np.float32)
    lamp[4, 4] = 1000
    moved = warp.sample(lamp, warp.as_homographies([[0.3, 0.4]])[0], (9, 9))
    assert moved.min() == 0
    assert moved.max() <= 1000


def test_samples_beyond_the_border_repeat_the_edge_pixels():
    moved = warp.sample(PICTURE, warp.as_homographies([[0, 20]])[0], (9, 12))
    assert np.allclose(moved, PICTURE[:, -1:], atol=1e-6)


def test_the_common_rectangle_of_shifted_images_is_their_overlap():
    rows, columns = warp.common_rectangle([[0, 0], [2, -3]], (9, 12))
    assert (rows, columns) == (slice(2, 9), slice(0, 9))


def test_the_common_rectangle_of_a_rotated_image_is_the_largest_inside():
    shape = (40, 60)
    H = warp.turn(shape, 10)
    rows, columns = warp.common_rectangle([H], shape)
    box = [
        [columns.start, rows.start],
        [columns.stop - 1, rows.start],
        [columns.stop - 1, rows.stop - 1],
        [columns.start, rows.stop - 1],
    ]
    source = warp.apply(np.linalg.inv(H), box)
    assert source.min() > -0.01
    assert np.all(source < np.array([60, 40]) - 0.99)


@pytest.mark.parametrize(
    "homographies",
    [
        [],
        [[1, 2, 3]],
        [["a", "b"]],
        [[np.nan, 1]],
        np.zeros((2, 3, 3)),
        [np.diag([1, 1, 0])],
    ],
)
def test_a_homography_that_is_not_invertible_raises_an_error(homographies):
    with pytest.raises(InputError):
        warp.as_homographies(homographies)


def test_as_many_homographies_as_images_are_required():
    with pytest.raises(ValueError, match="3"):
        warp.as_homographies([[0, 0], [1, 1]], 3)


def test_homographies_without_a_common_area_raise_an_error():
    with pytest.raises(ValueError, match="overlap"):
        warp.common_rectangle([[0, 0], [9, 0]], (9, 12))
