"""Checks of threshold(h, q), the threshold of a bitmap: the pixel value that a fraction q of the pixels
does not exceed.
"""

import numpy as np

from hdrlab.course.checks.compare import numbers, points, same


def draw_inputs(rng):
    """Return a mostly dark photo with an odd number of pixels."""
    return np.clip(255 * rng.beta(1.2, 4.0, (101, 77)), 0, 255).astype(np.uint8)


def histogram(Y):
    return np.bincount(Y.ravel(), minlength=256)


def is_valid_input(h, q):
    """Return whether no rounding decides where the cumulative histogram reaches a fraction."""
    fractions = np.ravel(q)
    if np.isin(fractions, [0.25, 0.5, 0.75]).all():
        return h.sum() > 0
    misses = np.cumsum(h)[:, None] - fractions * h.sum()
    return h.sum() > 0 and np.abs(misses).min() > 1e-6


@points(5)
def test_the_threshold_is_the_median(subject, rng):
    """The median is not the mean. In a dark image with a lamp they are far apart.

    Compute the cumulative histogram, and find where it reaches half of all pixels.

    t is the lowest pixel value whose cumulative count reaches q times the number of pixels.
    """
    for _ in range(3):
        Y = draw_inputs(rng)
        same(subject.threshold(histogram(Y), 0.5), np.median(Y), 0, what="t")


@points(3)
def test_any_fraction_can_be_used(subject, rng):
    """The argument q is the fraction; 0.5 gives the median.

    Is there a 0.5, or a division by 2, in your code?

    Compare the cumulative histogram with q times its last value.
    """
    Y = draw_inputs(rng)
    for q in (0.17, 0.33, 0.83):
        expected = np.sort(Y.ravel())[int(np.ceil(q * Y.size)) - 1]
        same(subject.threshold(histogram(Y), q), expected, 0, what=f"t of q = {q}")


@points(1, needs="test_any_fraction_can_be_used")
def test_several_fractions_give_one_value_each(subject, rng):
    """q can also be an array.

    For an array of fractions, return an array with one pixel value for each fraction.

    np.searchsorted accepts an array as well as a number. np.argmax of a comparison needs q[:,
    None].
    """
    Y = draw_inputs(rng)
    q = np.array([0.17, 0.5, 0.83])
    expected = [
        numbers(subject.threshold(histogram(Y), float(fraction)), what="t").item() for fraction in q
    ]
    same(subject.threshold(histogram(Y), q), expected, 0, what="the thresholds for three fractions")


@points(2)
def test_a_larger_photo_of_the_same_scene_has_the_same_threshold(subject, rng):
    """A larger photo of the same scene has the same median.

    Counts are not fractions. Divide them by their sum, or multiply q by the sum.

    Do not compare the cumulative counts with q itself.
    """
    Y = draw_inputs(rng)
    same(subject.threshold(7 * histogram(Y), 0.5), np.median(Y), 0, what="t")


def test_the_threshold_of_a_uniform_image_is_its_value(subject, rng):
    """All pixels of this image have the same value. What is the threshold?

    It is this value.

    The index into the histogram is the pixel value.
    """
    code = int(rng.integers(1, 255))
    same(subject.threshold(histogram(np.full((8, 9), code)), 0.5), code, 0, what="t")


@points(2)
def test_exactly_the_fraction_is_enough(subject, rng):
    """Exactly half of the pixels are 40 or darker, all others are 200. Which is the threshold?

    40. At 40, at least half of the pixels lie at or below.

    In np.searchsorted, side="left" finds the first place that reaches q. side="right" goes on.
    """
    low = int(rng.integers(10, 100))
    high = int(rng.integers(120, 240))
    h = np.zeros(256, int)
    h[low] = 32
    h[high] = 32
    same(subject.threshold(h, 0.5), low, 0, what="t of two equal halves")
    h[high] = 96
    same(subject.threshold(h, 0.25), low, 0, what="t of a quarter")
