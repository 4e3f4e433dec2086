"""Splines that can only rise: sums of steps, each of them a sum of cubic B-splines (Ramsay, 1988).

m    place         0 to 1
B_k  B-splines     K cubic ones, knots evenly over 0 to 1
S_k  steps         B_k + B_k+1 + ... + B_K-1: rises from 0 to 1
c    increments    (K,): g = sum_k c_k S_k; with c_1 ... c_K-1 >= 0 it never falls
h_k                how far B-spline k stands from the one before, so that c_k / h_k is a slope
"""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline

Float = NDArray[np.float64]


def knots(count: int) -> Float:
    """Return the knots of `count` cubic B-splines on 0 to 1."""
    return np.r_[[0.0] * 3, np.linspace(0, 1, count - 2), [1.0] * 3]


def steps(m: Float, count: int) -> Float:
    """Return S_k(m), (l, K): each rises from 0 to 1.

    Examples
    --------
    >>> steps(np.array([0.0, 1.0]), 5).round(3).tolist()
    [[1.0, 0.0, 0.0, 0.0, 0.0], [1.0, 1.0, 1.0, 1.0, 1.0]]
    """
    B = BSpline.design_matrix(np.clip(m, 0, 1), knots(count), 3).toarray()
    return B[:, ::-1].cumsum(axis=1)[:, ::-1]


def places(count: int) -> Float:
    """Return where the B-splines stand (K,), the means of their three inner knots (Greville's abscissae)."""
    t = knots(count)
    return (t[1:-3] + t[2:-2] + t[3:-1]) / 3


def bends(v: Float, grid: Float, count: int) -> Float:
    """Return the rows (K - 3, K) of (c / h)''_k / v_k; c_0 is a start, not a slope; v is given on a grid."""
    at = places(count)
    h, middle = np.diff(at), (at[1:] + at[:-1]) / 2
    rows = np.diff(np.diag(1 / h), 2, axis=0) / np.interp(middle[1:-1], grid, v)[:, None]
    return np.hstack([np.zeros((len(rows), 1)), rows])
