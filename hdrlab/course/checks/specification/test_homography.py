"""Checks of homography(source, target), which takes four corners to four others: H (3, 3)."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same

UNIT_SQUARE = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])


def draw_corners(rng, size=100.0, bend=0.2):
    """Return the corners (4, 2) of a convex quadrilateral without parallel sides."""
    bent = UNIT_SQUARE + rng.uniform(-bend, bend, (4, 2))
    angle = rng.uniform(-0.5, 0.5)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return bent @ turn.T * size + rng.uniform(0.3, 0.8, 2) * size


def move(H, p):
    """Return where points p (n, 2) lie after H, whatever its scale is."""
    uvw = np.column_stack([p, np.ones(len(p))]) @ H.T
    with np.errstate(all="ignore"):
        return uvw[:, :2] / uvw[:, 2:]


def same_corners(subject, source, target, what="where the corners lie after H"):
    H = finite(subject.homography(source, target), (3, 3), what="H").astype(float)
    size = np.abs(target).max()
    same(move(H, source), target, 1e-4 * size, what=what)


@points(4)
def test_a_parallelogram_needs_no_perspective(subject, rng):
    """The corners of a square go to those of a parallelogram. What is the last row of H?

    (0, 0, 1). The other six numbers follow from three of the corners.

    Each corner gives two equations, one for x and one for y.
    """
    sides = rng.uniform(20, 60, (2, 2)) * [[1, 0.3], [-0.3, 1]]
    source = UNIT_SQUARE * rng.uniform(0.5, 2, 2) + rng.uniform(0, 3, 2)
    target = UNIT_SQUARE @ sides + rng.uniform(20, 40, 2)
    same_corners(subject, source, target, "where the corners of a parallelogram lie after H")


@points(7)
def test_all_four_corners_go_to_their_targets(subject, rng):
    """Four corners are eight numbers. How many numbers of H are unknown?

    Eight, as H[2, 2] = 1. So a linear system of eight equations has one solution.

    x (h31 u + h32 v + 1) = h11 u + h12 v + h13, and y (h31 u + h32 v + 1) = h21 u + h22 v + h23.
    """
    same_corners(subject, UNIT_SQUARE * 50 + 10, draw_corners(rng))
    same_corners(subject, draw_corners(rng), draw_corners(rng))


@points(2)
def test_it_is_exact_in_a_large_photo(subject, rng):
    """The chart is in the corner of a photo of 24 megapixels. Is the result still exact?

    Yes, if you solve the linear system in double precision.

    Do not convert to float32.
    """
    target = draw_corners(rng, size=800.0) + [4000, 2500]
    same_corners(subject, UNIT_SQUARE * [6, 4], target, "where the corners lie in a large photo")


@points(2, needs="test_a_parallelogram_needs_no_perspective")
def test_its_last_element_is_1(subject, rng):
    """H and 2 H move all points alike. Which of them is the answer?

    That with H[2, 2] = 1.

    Divide H by H[2, 2].
    """
    H = subject.homography(UNIT_SQUARE * 50 + 10, draw_corners(rng))
    same(finite(H, (3, 3), what="H")[2, 2], 1, 1e-5, what="H[2, 2]")
