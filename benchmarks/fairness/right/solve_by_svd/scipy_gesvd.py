import numpy as np
from scipy import linalg


def solve_by_svd(A, b, *, rtol=1e-10):
    U, s, Vh = linalg.svd(A, full_matrices=False, lapack_driver="gesvd")
    inv = np.zeros_like(s)
    ok = s > rtol * s[0]
    inv[ok] = 1.0 / s[ok]
    return Vh.T @ (inv * (U.T @ b))
