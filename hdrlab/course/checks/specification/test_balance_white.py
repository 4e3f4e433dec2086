"""Checks of balance_white(X, c, gains), white balance on a mosaic: min(g_c X, 1)."""

import numpy as np

from hdrlab.capture import development
from hdrlab.course.checks.compare import points, same


def agree(subject, rng, gains, *, brightest, darkest=0.0):
    """Compare the balanced mosaics of random exposures behind random filters."""
    X = rng.uniform(darkest, brightest, (12, 18))
    c = rng.integers(0, 3, X.shape)
    answer, expected = (f(X, c, gains) for f in (subject.balance_white, development.balance_white))
    same(answer, expected, 1e-5, what="X")


@points(6)
def test_each_pixel_is_multiplied_by_the_gain_of_its_filter(subject, rng):
    """Each pixel has one filter. Which of the three gains does it get?

    c holds 0, 1 or 2 for each pixel. Use it as an index into the gains.

    gains[c] has the shape of X. Multiply the two.
    """
    gains = np.array([rng.uniform(1.8, 2.6), 1.0, rng.uniform(1.3, 1.7)])
    agree(subject, rng, gains, brightest=0.35)


@points(1)
def test_equal_gains_change_nothing(subject, rng):
    """If the three gains are equal, the channels are balanced already.

    Only the ratios of the gains count, and here the ratios are 1.

    After you divide by the smallest, all gains are 1.
    """
    agree(subject, rng, np.full(3, rng.uniform(1.5, 2.5)), brightest=0.35)


@points(4)
def test_gains_are_divided_by_the_smallest(subject, rng):
    """Two files can state the same white balance as (2, 1, 1.5) and as (1, 0.5, 0.75).

    Only the ratios of the gains count. Divide by one of the gains first. Which one?

    After gains / gains.min(), no gain is below 1.
    """
    for factor, smallest in ((rng.uniform(0.3, 0.6), 0), (rng.uniform(1.5, 3), 2)):
        gains = rng.uniform(1.4, 2.6, 3)
        gains[smallest] = 1
        agree(subject, rng, factor * gains, brightest=0.35)


@points(4)
def test_a_full_pixel_is_white_and_nothing_is_brighter(subject, rng):
    """A pixel of 1 is full: nobody knows how much more light there was. What does its gain do to it?

    It must be 1 behind each filter, so that it is white. A gain above 1 makes it brighter than that.

    Limit the product to at most 1.
    """
    gains = np.array([rng.uniform(1.8, 2.6), 1.0, rng.uniform(1.3, 1.7)])
    agree(subject, rng, gains, brightest=1.0, darkest=0.3)


@points(2)
def test_noise_below_zero_stays(subject, rng):
    """In the dark, noise is negative half of the time. What is the mean of this noise if you cut it off?

    Values below 0 keep their sign, so that the mean of the dark stays 0.

    Limit the product above, not below.
    """
    gains = np.array([rng.uniform(1.8, 2.6), 1.0, rng.uniform(1.3, 1.7)])
    agree(subject, rng, gains, brightest=0.01, darkest=-0.01)
