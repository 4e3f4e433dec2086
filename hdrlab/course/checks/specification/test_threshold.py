"""The threshold of a bitmap: threshold(h, q) -> the code that a fraction q of the pixels does not exceed."""

import numpy as np

from hdrlab.course.checks.compare import numbers, points, same


def drawn(rng):
    """Return a photograph, most of it dark, with an odd number of pixels."""
    return np.clip(255 * rng.beta(1.2, 4.0, (101, 77)), 0, 255).astype(np.uint8)


def histogram(Y):
    return np.bincount(Y.ravel(), minlength=256)


@points(5)
def test_the_threshold_is_the_median(subject, rng):
    """The median is not the mean: in a dark picture with a lamp they are far apart.

    Cumulate the histogram, and look for half of all pixels.

    t is the lowest code whose cumulated count reaches q times the count of all.
    """
    for _ in range(3):
        Y = drawn(rng)
        same(subject.threshold(histogram(Y), 0.5), np.median(Y), 0, what="t")


@points(3)
def test_any_fraction_can_be_asked_for(subject, rng):
    """The argument q is the fraction, 0.5 for the median.

    Is a 0.5, or a division by 2, written into your code?

    Compare the cumulated histogram with q times its last value.
    """
    Y = drawn(rng)
    for q in (0.17, 0.33, 0.83):
        expected = np.sort(Y.ravel())[int(np.ceil(q * Y.size)) - 1]
        same(subject.threshold(histogram(Y), q), expected, 0, what=f"t of q = {q}")


@points(1, needs="test_any_fraction_can_be_asked_for")
def test_several_fractions_give_a_code_each(subject, rng):
    """The sheet asks for one more thing of q: may it be an array?

    For an array of fractions an array of codes comes back, each for its own fraction.

    np.searchsorted takes an array as it takes a number; np.argmax of a comparison needs q[:, None].
    """
    Y, q = drawn(rng), np.array([0.17, 0.5, 0.83])
    expected = [numbers(subject.threshold(histogram(Y), float(one)), what="t").item() for one in q]
    same(subject.threshold(histogram(Y), q), expected, 0, what="the codes of three fractions")


@points(2)
def test_a_larger_photograph_of_the_same_codes_has_the_same_threshold(subject, rng):
    """A photograph twice as large of the same scene has the same median.

    Counts are not fractions: divide by their sum, or multiply q by it.

    Do not compare the cumulated counts with q itself.
    """
    Y = drawn(rng)
    same(subject.threshold(7 * histogram(Y), 0.5), np.median(Y), 0, what="t")


def test_the_threshold_of_an_even_wall_is_its_code(subject, rng):
    """An even wall: what else could its threshold be?

    Half of the pixels do not exceed the one code that there is.

    The index into the histogram is the code.
    """
    code = int(rng.integers(1, 255))
    same(subject.threshold(histogram(np.full((8, 9), code)), 0.5), code, 0, what="t")
