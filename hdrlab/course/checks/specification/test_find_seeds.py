"""The threshold of a ghost mask: find_seeds(score) -> mask (H, W)."""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.course.checks.compare import points, same
from hdrlab.radiance.deghosting import regions


def drawn(rng):
    """Return a score of wide and of thin places above 1, some at the edge."""
    score = 1 + 3 * gaussian_filter(rng.standard_normal((40, 50)), 2)
    score[int(rng.integers(10, 30)), :], score[:, int(rng.integers(10, 40))] = 2, 2
    return score.astype(np.float32)


@points(3)
def test_what_is_above_1_in_a_whole_square_is_marked(subject, rng):
    """Something that moved has a width. And an edge, and noise?

    Look at squares of 3 x 3 pixels: is all of one above 1?

    Mark all nine pixels of each such square, and nothing else.
    """
    for _ in range(3):
        score = drawn(rng)
        same(subject.find_seeds(score), regions.find_seeds(score), 0, what="the mask", picture=True)


def test_exactly_1_is_no_contradiction(subject, rng):
    """Is a score of 1 above 1?

    What noise explains just so is no motion.

    Compare with >, not with >=.
    """
    score = np.ones((16, 24))
    score[int(rng.integers(3, 6)) :, 7:12] += 0.5
    same(subject.find_seeds(score), score > 1, 0, what="the mask of one block", picture=True)


@points(1, needs="test_what_is_above_1_in_a_whole_square_is_marked")
def test_a_line_and_a_dot_are_no_motion(subject, rng):
    """A line of one pixel, or of two, is above 1. Which square lies in it?

    No square of 3 x 3 does.

    A pixel without a square is not marked, however high its score.
    """
    score = np.zeros((20, 30))
    score[int(rng.integers(3, 9))], score[14, int(rng.integers(3, 20))], score[16:18] = 9, 50, 3
    same(subject.find_seeds(score), score < 0, 0, what="the mask of lines", picture=True)
