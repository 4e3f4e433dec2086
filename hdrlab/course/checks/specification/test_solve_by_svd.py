"""Least squares by the SVD: solve_by_svd(A, b, rtol) -> the shortest x (k,)."""

import numpy as np

from hdrlab.course.checks.compare import points, same
from hdrlab.response.debevec import solve_by_svd


def drawn(rng, sigma):
    """Return A (m, k) with these singular values, and b (m,)."""
    m, k = len(sigma) + int(rng.integers(5, 20)), len(sigma)
    U, V = (np.linalg.qr(rng.standard_normal((n, k)))[0] for n in (m, k))
    return U * sigma @ V.T, rng.standard_normal(m)


def same_x(subject, A, b, **knobs):
    """Compare x with the library's, in units of its largest part."""
    x = solve_by_svd(A, b, **knobs)
    same(subject.solve_by_svd(A, b, **knobs), x, 1e-5 * np.abs(x).max(), what="x", kind="values")


@points(3)
def test_x_minimises_the_sum_of_squares(subject, rng):
    """A = U Sigma V^T. What is the x that comes closest to A x = b?

    Turn b into the directions u_i, divide by sigma_i, and turn it into those of v_i.

    x = sum of (u_i^T b / sigma_i) v_i; numpy returns V transposed: its rows are the v_i.
    """
    for k in (4, 12):
        same_x(subject, *drawn(rng, np.geomspace(1, 1e-4, k)), rtol=1e-8)


@points(4)
def test_of_many_answers_it_is_the_shortest(subject, rng):
    """A direction in which A measures nothing has sigma = 0. How far is x to go along it?

    Any distance is as good, and none at all is the shortest.

    Leave out the terms whose sigma is rounding alone: at most rtol times the largest.
    """
    rank = int(rng.integers(3, 7))
    A, b = drawn(rng, np.pad(np.geomspace(1, 1e-3, rank), (0, 8 - rank)))
    same_x(subject, A, b, rtol=1e-8)


@points(3)
def test_rtol_says_which_singular_values_count(subject, rng):
    """Which singular values are as good as 0?

    Compare each with the largest one, so that no unit matters.

    sigma_i > rtol sigma_1 counts, and all others do not.
    """
    A, b = drawn(rng, 10.0 ** -np.arange(6))
    for rtol in (0.05, 0.005):
        same_x(subject, A * 1e-3, b, rtol=rtol)
