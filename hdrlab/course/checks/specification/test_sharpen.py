"""Checks of sharpen(y, h), a moving object made sharp again by least squares: x (n, ...)."""

import numpy as np

from hdrlab.beyond import flutter
from hdrlab.course.checks.compare import points, same

CODE = np.array([float(chop) for chop in "1011000011101"])


def draw_inputs(rng, channels=(), noise=0.0):
    """Return the photo y of a moving object x, and x."""
    x = rng.uniform(0, 1, (int(rng.integers(30, 40)), *channels))
    y = flutter.smear(x, CODE)
    return y + noise * rng.standard_normal(y.shape), x


@points(5)
def test_without_noise_the_object_comes_back(subject, rng):
    """y = A x has more rows than unknowns. What are the rows of A?

    Each column of A is h / m, a row lower than the column before: y[i] = sum of h[k] x[i - k] / m.

    Build A from h, (n + m - 1, n), with n = len(y) - m + 1, and solve for x.
    """
    y, x = draw_inputs(rng)
    same(subject.sharpen(y, CODE), x, 1e-4, what="x", kind="curve")


@points(6)
def test_noise_is_fitted_by_least_squares(subject, rng):
    """With noise, no x fits all rows. Which one is right?

    The one with the smallest sum of squares of A x - y, over all n + m - 1 rows.

    A^T A x = A^T y, or numpy.linalg.lstsq(A, y).
    """
    y, _ = draw_inputs(rng, noise=0.03)
    same(subject.sharpen(y, CODE), flutter.sharpen(y, CODE), 1e-3, what="x", kind="curve")


@points(2)
def test_each_column_is_sharpened_by_itself(subject, rng):
    """A photo in color has three columns. How many systems are there?

    Three, with the same matrix.

    lstsq takes a matrix on the right, too. x is (n, 3).
    """
    y, _ = draw_inputs(rng, (3,), noise=0.01)
    same(subject.sharpen(y, CODE), flutter.sharpen(y, CODE), 1e-3, what="x in color", picture=True)


@points(2)
def test_another_code_is_inverted_as_well(subject, rng):
    """The shutter opens at other times. What changes?

    Only h, and so its length m and the matrix.

    Take m from h. Divide by m, and not by the number of open chops.
    """
    h = np.array([1.0, 1, 0, 1])
    x = rng.uniform(0, 1, 25)
    same(subject.sharpen(flutter.smear(x, h), h), x, 1e-4, what="x of another code", kind="curve")
