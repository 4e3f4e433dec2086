"""The parts of a ghost mask: label(mask) -> labels (H, W). Which part has which number is free."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same
from hdrlab.radiance.deghosting import regions


def drawn(rng):
    """Return a mask of several parts, which holds nothing in its first row."""
    mask = rng.uniform(size=(24, 32)) < 0.3
    mask[0] = False
    return mask


def numbered(labels):
    """Return labels by the order in which they come, from 0, row by row."""
    _, first, own = np.unique(labels, return_index=True, return_inverse=True)
    return np.argsort(np.argsort(first))[own].reshape(labels.shape)


def compared(subject, mask, what):
    """Compare which pixels have one label."""
    came = finite(subject.label(mask), mask.shape, what="labels")
    same(numbered(came), numbered(regions.label(mask)), 0, what=what, picture=True)


@points(4)
def test_pixels_that_connect_have_one_label_and_others_do_not(subject, rng):
    """Which pixels belong to one ghost?

    Those that a walk within the mask connects, from a pixel to one of its eight neighbours.

    scipy.ndimage.label takes the neighbourhood as its second argument.
    """
    compared(subject, drawn(rng), "the parts, numbered row by row")


@points(3, needs="test_pixels_that_connect_have_one_label_and_others_do_not")
def test_a_line_across_corners_is_one_part(subject, rng):
    """Do two pixels connect that touch in a corner?

    They do: a step may lead across a corner.

    np.ones((3, 3)) has all eight neighbours, the default only four.
    """
    n = int(rng.integers(8, 14))
    compared(subject, np.pad(np.eye(n, dtype=bool)[:, ::-1], 2), "the parts of a line")


@points(2, needs="test_pixels_that_connect_have_one_label_and_others_do_not")
def test_labels_are_1_to_r_and_0_elsewhere(subject, rng):
    """Which numbers have the parts? And what belongs to none?

    From 1 on, without a gap.

    0 where the mask is False.
    """
    mask = drawn(rng)
    count, came = (
        int(regions.label(mask).max()),
        finite(subject.label(mask), mask.shape, what="labels"),
    )
    same(np.unique(came), np.arange(count + 1), 0, what="the labels there are")
    same(came[~mask], np.zeros(np.count_nonzero(~mask)), 0, what="the labels outside of the mask")
