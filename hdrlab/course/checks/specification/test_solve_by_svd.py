"""Checks of solve_by_svd(A, b, rtol), least squares with the SVD: the shortest x (k,)."""

import numpy as np

from hdrlab.course.checks.compare import points, same
from hdrlab.response.debevec import solve_by_svd


def draw_inputs(rng, sigma):
    """Return A (m, k) with the singular values sigma, and b (m,)."""
    m = len(sigma) + int(rng.integers(5, 20))
    k = len(sigma)
    U, V = (np.linalg.qr(rng.standard_normal((n, k)))[0] for n in (m, k))
    return U * sigma @ V.T, rng.standard_normal(m)


def same_x(subject, A, b, **options):
    """Compare x with the library's, relative to its largest component."""
    x = solve_by_svd(A, b, **options)
    same(subject.solve_by_svd(A, b, **options), x, 1e-5 * np.abs(x).max(), what="x", kind="values")


@points(3)
def test_x_minimizes_the_sum_of_squares(subject, rng):
    """A = U Sigma V^T. Which x brings A x closest to b?

    Project b onto the directions u_i, divide by sigma_i, and multiply by v_i.

    x = sum of (u_i^T b / sigma_i) v_i. numpy returns V transposed, so its rows are the v_i.
    """
    for k in (4, 12):
        same_x(subject, *draw_inputs(rng, np.geomspace(1, 1e-4, k)), rtol=1e-8)


@points(4)
def test_of_all_solutions_x_is_the_shortest(subject, rng):
    """If sigma is 0 in a direction, A measures nothing there. How far should x go in this
    direction?

    All distances fit equally well, and 0 gives the shortest x.

    Leave out the terms whose sigma is only a rounding error: at most rtol times the largest one.
    """
    rank = int(rng.integers(3, 7))
    A, b = draw_inputs(rng, np.pad(np.geomspace(1, 1e-3, rank), (0, 8 - rank)))
    same_x(subject, A, b, rtol=1e-8)


@points(3)
def test_rtol_decides_which_singular_values_are_used(subject, rng):
    """Which singular values do you treat as 0?

    Compare each one with the largest, so that the unit does not matter.

    Use the terms with sigma_i > rtol sigma_1, and leave out all others.
    """
    A, b = draw_inputs(rng, 10.0 ** -np.arange(6))
    for rtol in (0.05, 0.005):
        same_x(subject, A * 1e-3, b, rtol=rtol)
