"""numpy's pseudo-inverse."""

import numpy as np


def solve_by_svd(A, b, *, rtol=1e-10):
    return np.linalg.pinv(A, rcond=rtol) @ b
