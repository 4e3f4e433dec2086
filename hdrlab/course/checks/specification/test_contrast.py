"""Checks of contrast(block), the mean distance of a block's values from their mean: a number."""

import numpy as np

from hdrlab.course.checks.compare import points, same
from hdrlab.enhance import battiato

SHAPE = (30, 40)


def same_contrast(subject, block, what="D"):
    D = battiato.contrast(block)
    same(subject.contrast(block), D, 2e-4 * D, what=what)


@points(4)
def test_the_contrast_is_the_mean_distance_from_the_mean(subject, rng):
    """Half of the block has the value 60, the other half 180. How far are they from their mean?

    60 each. So the contrast is 60.

    M is the mean over the histogram, and D the mean of |i - M| over it.
    """
    low = int(rng.integers(20, 80))
    high = int(rng.integers(150, 230))
    block = np.where(rng.random(SHAPE) < 0.3, low, high).astype(float)
    same_contrast(subject, block, what="D of a block with two values")
    same_contrast(subject, np.rint(rng.gamma(3, 15, SHAPE)).clip(4, 240), what="D of a block")


@points(4)
def test_the_histogram_is_smoothed_first(subject, rng):
    """A block has one single value. Is its contrast 0?

    Not after smoothing: the value counts a fifth at each of the five values around it.

    Replace each I[i] by the mean of I[i - 2] ... I[i + 2], and then compute M and D.
    """
    same_contrast(subject, np.full(SHAPE, float(rng.integers(40, 200))), what="D of one value")
    narrow = rng.integers(0, 3, SHAPE) + float(rng.integers(40, 200))
    same_contrast(subject, narrow, what="D of three values")


@points(2)
def test_beyond_its_ends_the_histogram_is_0(subject, rng):
    """The block is black. What are I[-2] and I[-1]?

    0: there are no such pixel values. So the smoothed histogram has fewer pixels.

    Divide by the sum of the smoothed histogram, not by the number of pixels.
    """
    block = np.where(rng.random(SHAPE) < rng.uniform(0.3, 0.7), 0.0, rng.integers(0, 3, SHAPE))
    same_contrast(subject, block, what="D of a dark block")
    same_contrast(subject, 255 - block, what="D of a bright block")
