"""lstsq is made of an SVD, and takes the same limit."""

import numpy as np


def solve_by_svd(A, b, *, rtol=1e-10):
    return np.linalg.lstsq(A, b, rcond=rtol)[0]
