"""Checks of consistency(v, v_), how far a neighbor agrees with a frame: f (H, W, 1)."""

import numpy as np

from hdrlab.beyond import video
from hdrlab.course.checks.compare import points, same

TOLERANCE = 1e-3
# the difference of values from which on a neighbor has no weight
LIMIT = 16 / 255
SHAPE = (12, 15)


def draw_pair(rng, channels, largest):
    """Return two frames (H, W, C) whose values differ by `largest` limits at most."""
    v = rng.uniform(0.25, 0.75, (*SHAPE, channels))
    v_ = v + largest * LIMIT * rng.uniform(-1, 1, v.shape)
    return v.astype(np.float32), v_.astype(np.float32)


def same_weight(subject, v, v_, what="f"):
    f = video.consistency(v, v_)
    same(subject.consistency(v, v_), f, TOLERANCE, what=what, picture=True)


@points(4)
def test_the_weight_falls_along_a_smooth_curve(subject, rng):
    """A neighbor differs a little. Should its weight drop at once?

    No: a little noise is no contradiction. f = 1 - 3 d^2 + 2 d^3 begins flat.

    d is |v - v_| divided by 16/255, since the values are from 0 to 1.
    """
    v, v_ = draw_pair(rng, 1, 1.0)
    same_weight(subject, v, v_)


@points(3)
def test_the_channel_that_differs_most_decides(subject, rng):
    """Red agrees, and blue does not. Is it the same object?

    No. One channel is enough.

    Take the maximum over the last axis, and keep this axis: keepdims=True.
    """
    v, v_ = draw_pair(rng, 3, 1.0)
    same_weight(subject, v, v_, what="f of colors")


@points(2)
def test_a_large_difference_has_no_weight(subject, rng):
    """d = 1.5 gives 1 - 6.75 + 6.75 = 1. Does a neighbor that differs so much agree again?

    No. From d = 1 on, the weight is 0.

    Limit d to 1 before you compute the polynomial.
    """
    v, v_ = draw_pair(rng, 1, 4.0)
    same_weight(subject, v, v_, what="f of large differences")


@points(1, needs="test_the_weight_falls_along_a_smooth_curve")
def test_a_brighter_and_a_darker_neighbor_count_alike(subject, rng):
    """Does it matter which of the two frames is brighter?

    No: both contradict the frame.

    Use the absolute difference.
    """
    v, v_ = draw_pair(rng, 1, 0.9)
    darker = np.minimum(v, v_)
    brighter = np.maximum(v, v_)
    same_weight(subject, darker, brighter, what="f of a brighter neighbor")
    same_weight(subject, brighter, darker, what="f of a darker neighbor")
