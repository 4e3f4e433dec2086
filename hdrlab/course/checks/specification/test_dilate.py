"""The margin of a ghost mask: dilate(mask, margin) -> mask (H, W)."""

import numpy as np
from scipy.ndimage import distance_transform_edt

from hdrlab.course.checks.compare import points, same
from hdrlab.radiance.deghosting import regions


def drawn(rng):
    """Return a mask of some pixels and a bar, and a margin."""
    mask = rng.uniform(size=(40, 50)) < 0.004
    mask[int(rng.integers(5, 30)), 8:20] = True
    return mask, int(rng.integers(3, 6))


@points(5)
def test_all_within_the_margin_belongs_to_the_mask(subject, rng):
    """How far is a pixel from the nearest one of the mask?

    By the straight line: a margin is round, not square.

    Take what is at most `margin` from a pixel of the mask.
    """
    mask, margin = drawn(rng)
    near, widened = distance_transform_edt(~mask) <= margin, regions.dilate(mask, margin)
    # its holes are another promise's
    same(
        subject.dilate(mask, margin), near, 0, what="the mask", picture=True, where=near == widened
    )


@points(3)
def test_the_inside_of_a_figure_belongs_to_it(subject, rng):
    """Somebody who moved is found by the outline. And the inside?

    A hole that the widened mask encloses on all sides belongs to it, even where the outline had a
    gap.

    Fill the holes after the margin was added.
    """
    closed = np.zeros((40, 40), bool)
    closed[6:34, 6:34] = True
    closed[8:32, 8:32] = False
    ring = closed.copy()
    ring[6:8, 18:20] = False
    margin = int(rng.integers(3, 5))
    for mask in (closed, ring):
        came = subject.dilate(mask, margin)
        same(came, regions.dilate(mask, margin), 0, what="the mask of a ring", picture=True)


@points(1, needs="test_all_within_the_margin_belongs_to_the_mask")
def test_where_nothing_moved_there_is_no_mask(subject, rng):
    """A mask may be empty. How far is the nearest pixel of it then?

    There is none.

    An empty mask stays empty.
    """
    nothing = np.zeros((12, int(rng.integers(10, 20))), bool)
    same(subject.dilate(nothing, 3), nothing, 0, what="the empty mask", picture=True)
