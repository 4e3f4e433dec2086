"""Checks of exclusion(Y, t), the exclusion bitmap: True where a pixel is compared."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, require, same

CODES = np.arange(256, dtype=np.uint8)[None]


def test_every_pixel_is_either_compared_or_not(subject, rng):
    """The result has the shape of the image.

    Return True or False (1 or 0) for every pixel.

    A comparison of arrays gives an array of bool.
    """
    Y = rng.integers(0, 256, (6, 9), dtype=np.uint8)
    answer = finite(subject.exclusion(Y, 120), (6, 9), what="where Y is compared")
    require(
        np.isin(answer, [0, 1]).all(), f"expected True or False, got values up to {answer.max():g}"
    )


@points(4)
def test_pixels_close_to_the_threshold_are_not_compared(subject, rng):
    """Is your bitmap True where a pixel is compared, or where it is left out?

    Noise decides the bit of a pixel close to the threshold, so do not compare such a pixel.

    |Y - t| > 4.
    """
    t = int(rng.integers(20, 230))
    far = np.abs(CODES.astype(int) - t) > 12
    close = CODES == t
    same(subject.exclusion(CODES, t), far, 0, what="where Y is compared", where=far | close)


@points(3)
def test_it_leaves_out_the_four_values_on_either_side(subject, rng):
    """Work out by hand what happens to the values t - 5, t - 4, t + 4 and t + 5.

    Four values on either side are left out, and t itself.

    Use > 4 and not >= 4.
    """
    t = int(rng.integers(20, 230))
    same(
        subject.exclusion(CODES, t),
        np.abs(CODES.astype(int) - t) > 4,
        0,
        what="where Y is compared",
    )


@points(3)
def test_bytes_do_not_wrap_around(subject, rng):
    """What is 3 - 5 in uint8?

    A byte cannot be negative: the difference wraps around to 254.

    Convert Y to int before you subtract, or compare with t - 4 and t + 4.
    """
    Y = rng.integers(0, 256, (30, 40), dtype=np.uint8)
    for t in (2, 250):
        expected = np.abs(Y.astype(int) - t) > 4
        same(subject.exclusion(Y, t), expected, 0, what="where Y is compared", picture=True)
