"""Checks of find_seeds(score), the threshold of a ghost mask: mask (H, W)."""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.course.checks.compare import points, same
from hdrlab.radiance.deghosting import regions


def draw_inputs(rng):
    """Return a score with wide and thin areas above 1, some of them at the border."""
    score = 1 + 3 * gaussian_filter(rng.standard_normal((40, 50)), 2)
    score[int(rng.integers(10, 30)), :] = 2
    score[:, int(rng.integers(10, 40))] = 2
    return score.astype(np.float32)


def is_valid_input(score):
    """Return whether the image is as large as the squares that are looked for."""
    return min(score.shape) >= regions.SEED_SIDE


@points(3)
def test_squares_that_are_entirely_above_1_are_marked(subject, rng):
    """A moving object covers an area. Noise and edges do not.

    Look at each square of 3 x 3 pixels: are all nine scores above 1?

    Mark all nine pixels of each such square, and no other pixel.
    """
    for _ in range(3):
        score = draw_inputs(rng)
        same(subject.find_seeds(score), regions.find_seeds(score), 0, what="the mask", picture=True)


def test_a_score_of_exactly_1_is_not_marked(subject, rng):
    """Is a score of 1 above 1?

    A score of exactly 1 can still be noise.

    Compare with >, not with >=.
    """
    score = np.ones((16, 24))
    score[int(rng.integers(3, 6)) :, 7:12] += 0.5
    same(subject.find_seeds(score), score > 1, 0, what="the mask of one block", picture=True)


@points(1, needs="test_squares_that_are_entirely_above_1_are_marked")
def test_lines_and_dots_are_not_marked(subject, rng):
    """Lines of one or two pixels are above 1 here. Does a square of 3 x 3 pixels fit into them?

    No square fits.

    Do not mark a pixel outside such a square, however high its score is.
    """
    score = np.zeros((20, 30))
    score[int(rng.integers(3, 9))] = 9
    score[14, int(rng.integers(3, 20))] = 50
    score[16:18] = 3
    same(subject.find_seeds(score), score < 0, 0, what="the mask of lines", picture=True)
