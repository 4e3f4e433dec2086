"""Checks of dilate(mask, margin), the margin of a ghost mask: mask (H, W)."""

import numpy as np
from scipy.ndimage import binary_fill_holes, distance_transform_edt

from hdrlab.course.checks.compare import points, same
from hdrlab.radiance.deghosting import regions


def draw_inputs(rng):
    """Return a mask with a few single pixels and a bar, and a margin."""
    mask = rng.uniform(size=(40, 50)) < 0.004
    mask[int(rng.integers(5, 30)), 8:20] = True
    return mask, int(rng.integers(3, 6))


def with_a_hole_at_a_corner(rng):
    """Return a mask, and the same mask widened by 1 and filled.

    A hole in it is closed to steps up, down, left and right, but open to diagonal steps.
    """
    while True:
        mask = rng.uniform(size=(40, 50)) < 0.15
        near = distance_transform_edt(~mask) <= 1
        filled = binary_fill_holes(near)
        if np.any(filled != binary_fill_holes(near, np.ones((3, 3)))):
            return mask, filled


@points(5)
def test_pixels_within_the_margin_are_marked(subject, rng):
    """How far is a pixel from the nearest pixel of the mask?

    Measure the straight distance: the margin is round, not square.

    Mark every pixel that is at most `margin` away from a pixel of the mask.
    """
    mask, margin = draw_inputs(rng)
    near = distance_transform_edt(~mask) <= margin
    widened = regions.dilate(mask, margin)
    # another check tests the holes
    same(
        subject.dilate(mask, margin), near, 0, what="the mask", picture=True, where=near == widened
    )


@points(3)
def test_the_inside_of_an_outline_is_marked(subject, rng):
    """When a person moves, the mask may show only the outline. What happens to the inside?

    Mark a hole that the widened mask encloses on all sides, even if the outline had a gap.

    Fill the holes after you have added the margin. A path of diagonal steps does not open a hole.
    """
    closed = np.zeros((40, 40), bool)
    closed[6:34, 6:34] = True
    closed[8:32, 8:32] = False
    ring = closed.copy()
    ring[6:8, 18:20] = False
    margin = int(rng.integers(3, 5))
    for mask in (closed, ring):
        answer = subject.dilate(mask, margin)
        same(answer, regions.dilate(mask, margin), 0, what="the mask of a ring", picture=True)
    dots, filled = with_a_hole_at_a_corner(rng)
    same(subject.dilate(dots, 1), filled, 0, what="the mask of dots", picture=True)


@points(1, needs="test_pixels_within_the_margin_are_marked")
def test_an_empty_mask_stays_empty(subject, rng):
    """A mask can be empty. How far is the nearest pixel of the mask then?

    There is none.

    Return an empty mask for an empty mask.
    """
    nothing = np.zeros((12, int(rng.integers(10, 20))), bool)
    same(subject.dilate(nothing, 3), nothing, 0, what="the empty mask", picture=True)
