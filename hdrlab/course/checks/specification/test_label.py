"""Checks of label(mask), the parts of a ghost mask: labels (H, W). The numbers can be in any
order.
"""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same
from hdrlab.radiance.deghosting import regions


def draw_inputs(rng):
    """Return a mask of several parts with an empty first row."""
    mask = rng.uniform(size=(24, 32)) < 0.3
    mask[0] = False
    return mask


def numbered(labels):
    """Return labels renumbered from 0 in the order in which they appear, row by row."""
    _, first, own = np.unique(labels, return_index=True, return_inverse=True)
    return np.argsort(np.argsort(first))[own].reshape(labels.shape)


def same_parts(answer, mask, what):
    """Compare which pixels share a label."""
    same(numbered(answer), numbered(regions.label(mask)), 0, what=what, picture=True)


def same_numbers(answer, mask):
    """Compare which labels there are, and those outside the mask."""
    count = int(regions.label(mask).max())
    expected = np.arange(count + 1)[int(mask.all()) :]
    same(np.unique(answer), expected, 0, what="the set of labels")
    same(answer[~mask], np.zeros(np.count_nonzero(~mask)), 0, what="the labels outside the mask")


def compared(subject, mask, what):
    """Compare which pixels share a label."""
    same_parts(finite(subject.label(mask), mask.shape, what="labels"), mask, what)


def check_one_input(subject, mask):
    """Compare which pixels share a label, and the labels themselves."""
    answer = finite(subject.label(mask), mask.shape, what="labels")
    same_parts(answer, mask, "labels")
    same_numbers(answer, mask)


@points(4)
def test_connected_pixels_share_a_label(subject, rng):
    """Which pixels belong to the same ghost?

    Two pixels belong together if a path inside the mask connects them. Each step goes to one of the
    eight neighbors.

    scipy.ndimage.label takes the neighborhood as its second argument.
    """
    compared(subject, draw_inputs(rng), "the parts, numbered row by row")


@points(3, needs="test_connected_pixels_share_a_label")
def test_a_diagonal_line_is_one_part(subject, rng):
    """Are two pixels connected if they touch only at a corner?

    They are: a step can go across a corner.

    Pass np.ones((3, 3)), which has all eight neighbors. The default has only four.
    """
    n = int(rng.integers(8, 14))
    compared(subject, np.pad(np.eye(n, dtype=bool)[:, ::-1], 2), "the parts of a line")


@points(2, needs="test_connected_pixels_share_a_label")
def test_labels_are_1_to_r_and_0_elsewhere(subject, rng):
    """Which numbers do the regions have? And the pixels outside the mask?

    Number the regions from 1 without gaps.

    Use 0 where the mask is False.
    """
    mask = draw_inputs(rng)
    same_numbers(finite(subject.label(mask), mask.shape, what="labels"), mask)
