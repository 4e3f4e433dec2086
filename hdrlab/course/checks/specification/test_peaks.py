"""Checks of peaks(c, count), the shifts of the highest peaks of a correlation: (count, 2)."""

import numpy as np

from hdrlab.align import cerman
from hdrlab.course.checks.compare import points, same

SHAPE = (37, 51)


def draw_inputs(rng):
    """Return a correlation c in which large values stand beside each other."""
    c = rng.normal(0, 1, SHAPE)
    for height in (9, 8, 7):
        y = rng.integers(8, 28)
        x = rng.integers(8, 42)
        c[y - 1 : y + 2, x - 1 : x + 2] = height + rng.uniform(0, 0.8, (3, 3))
    return c


def is_valid_input(c, count):
    """Return whether no two values tie for a peak, and the map has an inside."""
    above = c[c > 0]
    return min(c.shape) >= 5 and 0 < len(np.unique(above)) == len(above)


@points(4)
def test_the_highest_peak_is_given_as_a_shift(subject, rng):
    """Where is the largest value of c, and to which shift does it belong?

    The middle of c is the shift (0, 0).

    Subtract (h - 1, w - 1) from its row and column. The order is (dy, dx).
    """
    c = draw_inputs(rng)
    same(subject.peaks(c, 1), cerman.peaks(c, 1), 0, what="the shift of the highest peak")


@points(4)
def test_the_values_beside_a_peak_are_no_peaks(subject, rng):
    """The second largest value lies beside the largest one. Is it another peak?

    No. A peak is the largest value of the 5 x 5 values around it.

    scipy.ndimage.maximum_filter(c, 5) gives the largest of these values for each place.
    """
    for count in (3, 6):
        c = draw_inputs(rng)
        row = rng.integers(8, 28)
        column = rng.integers(8, 40)
        c[row, column] = 20
        c[row, column + 3] = 19  # not among the 5 x 5 values around the other
        same(
            subject.peaks(c, count), cerman.peaks(c, count), 0, what=f"the shifts of {count} peaks"
        )


@points(2)
def test_a_peak_may_lie_at_the_edge(subject, rng):
    """Has a value at the edge of c 5 x 5 neighbors?

    No. It is compared with those that there are.

    Do not leave out the first or the last two rows and columns.
    """
    c = draw_inputs(rng)
    column = int(rng.integers(5, 45))
    c[0, column] = 30
    c[-1, column + 1] = 28  # the opposite edge is far away
    row = int(rng.integers(5, 30))
    c[row, -2] = 25
    c[row, 0] = 22
    same(subject.peaks(c, 4), cerman.peaks(c, 4), 0, what="the shifts of 4 peaks")


@points(2)
def test_fewer_peaks_are_returned_if_the_others_are_not_above_0(subject, rng):
    """c is negative except at two places, and three peaks are asked. Which is the third?

    There is none: a correlation below 0 is no match.

    Return only peaks with c above 0, even if they are fewer than count.
    """
    c = draw_inputs(rng) - 20
    c[12, int(rng.integers(5, 20))] = 1 + rng.random()
    c[30, int(rng.integers(20, 45))] = 3 + rng.random()
    same(subject.peaks(c, 3), cerman.peaks(c, 3), 0, what="the shifts of the 2 peaks above 0")
