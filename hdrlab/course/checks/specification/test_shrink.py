"""Checks of shrink(Y), a level of the pyramid: half the size."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same


def means(Y):
    """Return the mean of each block of 2 x 2 pixels, not rounded."""
    rows = Y.shape[0] // 2
    columns = Y.shape[1] // 2
    return Y[: 2 * rows, : 2 * columns].reshape(rows, 2, columns, 2).mean(axis=(1, 3))


def check_one_input(subject, Y):
    """Compare with the exact means of four pixels; those that end in .5 may be rounded up or down."""
    H, W = (length // 2 * 2 for length in Y.shape)
    means = Y[:H, :W].astype(float).reshape(H // 2, 2, W // 2, 2).mean(axis=(1, 3))
    same(subject.shrink(Y), means, 0.5, what="the level")


def test_a_level_has_half_the_rows_and_columns(subject, rng):
    """How many rows does the next level have?

    Half of the rows, and half of the columns.

    16 x 20 pixels become 8 x 10.
    """
    Y = rng.integers(0, 60, (16, 20), dtype=np.uint8)
    finite(subject.shrink(Y), (8, 10), what="the level")


@points(4)
def test_a_level_is_the_rounded_mean_of_four_pixels(subject, rng):
    """Use every pixel of the image; do not skip any.

    A pixel of the next level is the mean of four pixels.

    Round to the nearest whole number. Truncation makes every level darker.
    """
    Y = rng.integers(0, 60, (24, 36), dtype=np.uint8)
    same(subject.shrink(Y), means(Y), 0.5, what="the level", picture=True)


@points(3)
def test_a_bright_sky_does_not_overflow(subject, rng):
    """What is 200 + 100 in uint8?

    The sum of four bytes does not fit into a byte.

    Convert Y to a wider type before you add.
    """
    Y = rng.integers(180, 256, (16, 20), dtype=np.uint8)
    same(subject.shrink(Y), means(Y), 0.5, what="the level", picture=True)


@points(3)
def test_an_odd_row_or_column_is_left_out(subject, rng):
    """Half of 7 rows are 3 rows.

    If the number of rows or columns is odd, leave out the last one.

    Crop the image to an even size first.
    """
    Y = rng.integers(0, 256, (17, 23), dtype=np.uint8)
    same(subject.shrink(Y), means(Y), 0.5, what="the level", picture=True)
