"""Conjugate gradients of the quadratic function; a column."""

import numpy as np


def solve_map(A, b, sd):
    z = np.zeros(len(sd))
    B = A * sd
    r = B.T @ b
    p, rr = r.copy(), r @ r
    for _ in range(200):
        if rr < 1e-28:
            break
        q = B.T @ (B @ p) + p
        alpha = rr / (p @ q)
        z, r = z + alpha * p, r - alpha * q
        p, rr = r + (r @ r) / rr * p, r @ r
    return (sd * z)[:, None]
