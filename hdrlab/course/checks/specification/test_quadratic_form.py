"""Checks of quadratic_form(blends, degree), the error of a polynomial through blends: Q (d + 1, d + 1)."""

import numpy as np

from hdrlab.calibration.blends import Blend
from hdrlab.calibration.wilburn import quadratic_form
from hdrlab.course.checks.compare import finite, points, same


def draw_inputs(rng, count):
    """Return blends (I, M) of a camera, each of another length, and of another scale and offset."""
    blends = []
    for _ in range(count):
        x = np.sort(rng.uniform(0, 1, int(rng.integers(8, 14))))
        exposure = rng.uniform(0.3, 0.7) * x + rng.uniform(0.05, 0.3)
        M = exposure ** rng.uniform(0.4, 0.6) + 0.05 * rng.standard_normal(len(x))
        blends.append(Blend(rng.uniform(1, 4) * x, M))
    return blends


def is_valid_input(blends, degree):
    """Return whether each blend has at least three different points."""
    return all(min(len(np.unique(x)), len(np.unique(M))) >= 3 for x, M in blends)


def same_form(subject, blends, degree, what="Q"):
    Q = quadratic_form(blends, degree)
    same(subject.quadratic_form(blends, degree), Q, 1e-4 * np.abs(Q).max(), what=what, picture=True)


@points(6)
def test_the_error_is_what_is_left_of_a_line_through_one_blend(subject, rng):
    """g(M) should be a straight line in I. Which s and r are best?

    Those of the least-squares line through the points (I, g(M)). The error is what is left.

    V has the columns M^0, M^1 ... M^d. Subtract from each column its own line in I. With what is
    left, R, the error of a is |R a|^2, so Q = R^T R.
    """
    same_form(subject, draw_inputs(rng, 1), int(rng.integers(2, 5)))


@points(6)
def test_each_blend_has_a_line_of_its_own(subject, rng):
    """Two blends have another light. Do they have the same s and r?

    No: each has its own.

    Compute Q of each blend by itself, and add them up.
    """
    same_form(subject, draw_inputs(rng, 3), 4, what="Q of three blends")


@points(2, needs="test_the_error_is_what_is_left_of_a_line_through_one_blend")
def test_a_curve_that_is_the_cameras_has_no_error(subject, rng):
    """The camera's inverse response is a polynomial a. What is a^T Q a?

    0: with this a, all blends are straight lines.

    If it is not 0, your lines go through the origin, or the powers begin with M^1.
    """
    a = np.array([0.0, 0.5, 0.2, 0.3])
    blends = []
    for _ in range(2):
        M = np.sort(rng.uniform(0, 1, 12))
        g = np.polynomial.polynomial.polyval(M, a)
        blends.append(Blend((g - rng.uniform(0, 0.3)) / rng.uniform(0.5, 2), M))
    Q = finite(subject.quadratic_form(blends, 3), (4, 4), what="Q").astype(float)
    scale = float(np.abs(quadratic_form(blends, 3)).max())
    same(a @ Q @ a / scale, 0, 1e-6, what="a^T Q a")
    offset = np.array([0.7, 0.5, 0.2, 0.3])
    same(offset @ Q @ offset / scale, 0, 1e-6, what="a^T Q a with another a_0")
