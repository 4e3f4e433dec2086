"""A level of the pyramid: shrink(Y) -> half the size."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same


def means(Y):
    """Return the mean of each 2 x 2 pixels, not rounded."""
    rows, columns = Y.shape[0] // 2, Y.shape[1] // 2
    return Y[: 2 * rows, : 2 * columns].reshape(rows, 2, columns, 2).mean(axis=(1, 3))


def test_a_level_has_half_the_rows_and_columns(subject, rng):
    """How many rows has the next level?

    Half of them, and half of the columns.

    16 x 20 pixels become 8 x 10.
    """
    Y = rng.integers(0, 60, (16, 20), dtype=np.uint8)
    finite(subject.shrink(Y), (8, 10), what="the level")


@points(4)
def test_a_level_is_the_rounded_mean_of_four_pixels(subject, rng):
    """Every pixel of the photograph counts: none is skipped.

    A pixel of the next level is the mean of four.

    Round to the nearest whole code; cutting off the fraction makes every level darker.
    """
    Y = rng.integers(0, 60, (24, 36), dtype=np.uint8)
    same(subject.shrink(Y), means(Y), 0.5, what="the level", picture=True)


@points(3)
def test_a_bright_sky_does_not_overflow(subject, rng):
    """What is 200 + 100 in uint8?

    The sum of four bytes needs more than a byte.

    Turn Y into a wider type before you add.
    """
    Y = rng.integers(180, 256, (16, 20), dtype=np.uint8)
    same(subject.shrink(Y), means(Y), 0.5, what="the level", picture=True)


@points(3)
def test_an_odd_row_or_column_is_left_out(subject, rng):
    """Half of 7 rows are 3.

    The last row or column of an odd number has no partner, and is left out.

    Cut the picture to an even size first.
    """
    Y = rng.integers(0, 256, (17, 23), dtype=np.uint8)
    same(subject.shrink(Y), means(Y), 0.5, what="the level", picture=True)
