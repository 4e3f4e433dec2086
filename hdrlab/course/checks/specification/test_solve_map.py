"""Checks of solve_map(A, b, sd), coefficients by least squares with a prior: c (K,)."""

import numpy as np

from hdrlab.course.checks.compare import points, same
from hdrlab.response import space


def draw_inputs(rng, rows=None):
    """Return A (m, K), b (m,) and sd (K,)."""
    K = int(rng.integers(4, 7))
    m = rows or K + int(rng.integers(3, 12))
    return rng.standard_normal((m, K)), 3 * rng.standard_normal(m), np.geomspace(2, 0.15, K)


def same_coefficients(subject, A, b, sd, *, what="c"):
    c = space.solve_map(A, b, sd)
    same(subject.solve_map(A, b, sd), c, 1e-4 * np.abs(c).max(), what=what, kind="values")


@points(6)
def test_the_coefficients_minimize_the_errors_and_the_distance_from_the_prior(subject, rng):
    """A coefficient with a small sd is nearly 0 in all cameras. Which c / sd is then plausible?

    One of about 1 or less. So |c / sd|^2 is added to the squared errors, |A c - b|^2.

    Add a row with 1 / sd_k in column k to A for each coefficient, and a 0 to b, and solve by least
    squares. Or solve (A^T A + diag(1 / sd^2)) c = A^T b.
    """
    same_coefficients(subject, *draw_inputs(rng))


@points(4)
def test_fewer_equations_than_coefficients_are_enough(subject, rng):
    """Three samples of a curve, and five coefficients. Can you solve for them?

    Yes: the prior decides what the samples leave open.

    With the rows of the prior, the system has K + m equations, and one solution.
    """
    same_coefficients(subject, *draw_inputs(rng, rows=3), what="c from three equations")


@points(2)
def test_with_a_wide_prior_the_equations_decide(subject, rng):
    """sd is a thousand. What does the prior say?

    Nothing: all coefficients are equally plausible.

    c is the solution of ordinary least squares. Divide by sd in the penalty; do not multiply.
    """
    A, b, sd = draw_inputs(rng)
    c = np.linalg.lstsq(A, b)[0]
    answer = subject.solve_map(A, b, 1e3 * np.ones(len(sd)))
    same(answer, c, 1e-4 * np.abs(c).max(), what="c with a wide prior", kind="values")
