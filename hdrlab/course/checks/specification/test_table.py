"""Checks of table(delta, a, c), a look-up table that adds light to a photo: (256,) pixel values."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, require, same
from hdrlab.enhance import relight

# of a rounded value to the value itself: a half either way, and the error of float32
HALF = 0.502


def same_table(subject, delta, what="the table", **shape):
    """Compare a table with the curve, whose halves may be rounded either way; values must be whole."""
    expected = relight.curve(delta, **shape)
    answer = finite(subject.table(delta, **shape), (256,), what=what).astype(float)
    same(answer, expected, HALF, what=what, kind="curve")
    require(
        np.all(answer == np.round(answer)),
        f"{what}: expected whole pixel values, got {answer[1]:.6g}",
    )


@points(5)
def test_every_value_moves_along_the_curve(subject, rng):
    """A pixel has the value Y. Which value would it have with delta stops more light?

    Its light is q = f^-1(Y). Add delta to it, and take f.

    Y' = f(f^-1(Y) + delta), for all Y from 0 to 255 at once.
    """
    for delta in (float(rng.uniform(0.5, 2)), float(-rng.uniform(0.5, 2))):
        same_table(subject, delta, what=f"the table for {delta:.2g} stops")


@points(2)
def test_the_curve_of_the_table_has_the_shape_of_a_and_c(subject, rng):
    """A and C describe a camera. Does your table know them?

    Another camera has another curve.

    Use `a` and `c` in f and in f^-1.
    """
    shape = {"a": float(rng.uniform(0.8, 1.3)), "c": float(rng.uniform(0.4, 0.9))}
    same_table(subject, float(rng.uniform(1, 2)), what="the table of another camera", **shape)


@points(2, needs="test_every_value_moves_along_the_curve")
def test_no_light_added_changes_no_value(subject):
    """delta is 0. Which table is that?

    The identity: 0, 1, 2 ... 255.

    If some values are one too low, you cut the fraction off. Round to the nearest value.
    """
    same(subject.table(0.0), np.arange(256), 0, what="the table for 0 stops", kind="curve")


@points(1, needs="test_every_value_moves_along_the_curve")
def test_black_stays_black_and_white_stays_white(subject, rng):
    """f^-1(0) is -inf, and f^-1(255) is inf. What is f there?

    -inf and inf stay what they are, whatever is added: f is 0 and 255.

    If your table has NaN there, set these two values by hand.
    """
    for delta in (-5.0, float(rng.uniform(4, 6))):
        answer = finite(subject.table(delta), (256,), what="the table")
        same(answer[[0, -1]], [0, 255], 0, what="the values for black and white")
