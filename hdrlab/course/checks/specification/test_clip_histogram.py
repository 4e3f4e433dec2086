"""Checks of clip_histogram(h, limit), a histogram whose bins hold at most a limit: (bins,)."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same
from hdrlab.tonemap import brush


def draw_inputs(rng, bins=24):
    """Return a histogram of fractions with two high bins, some low ones and an empty one."""
    h = rng.uniform(0.2, 1.5, bins)
    h[int(rng.integers(2, 8))] *= 12
    h[int(rng.integers(10, 20))] *= 8
    h[-2] = 0
    return h / h.sum()


SMALL_INPUTS = [
    (np.array([0.7, 0.2, 0.1]), {"limit": 1.5}),
    (np.array([0.8, 0.2, 0.0]), {"limit": 1.0}),
    (np.array([0.5, 0.25, 0.25]), {"limit": 1.2}),
]


@points(6)
def test_the_excess_goes_where_there_is_room(subject, rng):
    """Two bins are above the limit. Where do their pixels go?

    Into the other bins, each in proportion to the room that it has below the limit.

    room = top - min(h, top), and the result is min(h, top) + room * excess / sum(room).
    """
    h = draw_inputs(rng)
    for limit in (float(rng.uniform(1.5, 2)), float(rng.uniform(2.2, 3))):
        expected = brush.clip_histogram(h, limit=limit)
        same(subject.clip_histogram(h, limit=limit), expected, 1e-6, what="h", kind="curve")


@points(3)
def test_no_pixel_is_lost_and_no_bin_is_above_the_limit(subject, rng):
    """h are fractions of all pixels. What is their sum, before and after?

    1, since no pixel is lost. And no bin may be above limit / bins.

    If your sum is less than 1, the excess is missing. If a bin is too high, do not distribute the
    excess evenly.
    """
    h = draw_inputs(rng, bins=int(rng.integers(30, 60)))
    h_clipped = finite(subject.clip_histogram(h, limit=1.4), h.shape, what="h")
    same(h_clipped.sum(), 1, 1e-5, what="the sum of h")
    same(
        np.maximum(h_clipped * len(h), 1.4), np.full(len(h), 1.4), 1e-4, what="bins above the limit"
    )
    same(np.minimum(h_clipped - np.minimum(h, 1.4 / len(h)), 0), 0 * h, 1e-6, what="bins that lost")


@points(2, needs="test_the_excess_goes_where_there_is_room")
def test_a_limit_of_1_makes_all_bins_equal(subject, rng):
    """No bin may have more than the mean. What do all bins have?

    The mean: 1 / bins.

    The limit counts in means: top = limit / bins.
    """
    h = draw_inputs(rng)
    answer = subject.clip_histogram(h, limit=1.0)
    same(answer, np.full(len(h), 1 / len(h)), 1e-6, what="h for a limit of 1", kind="curve")


@points(1, needs="test_the_excess_goes_where_there_is_room")
def test_a_histogram_below_the_limit_stays(subject, rng):
    """No bin is above the limit. What is there to do?

    Nothing: the excess is 0.

    If values change, you divide by something that is not 1 here.
    """
    h = draw_inputs(rng)
    same(subject.clip_histogram(h, limit=22.0), h, 1e-6, what="h with a high limit", kind="curve")
