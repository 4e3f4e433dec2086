"""A sparse Laplacian, the first pixel held at 0, scipy's direct solver, then the mean taken off."""

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve


def second_difference(n):
    d = sparse.diags_array([-np.ones(n), np.ones(n - 1)], offsets=[0, 1], shape=(n, n)).tolil()
    d[n - 1, :] = 0
    d = d.tocsr()
    return -(d.T @ d)


def solve(divG):
    f = np.asarray(divG)
    if f.ndim != 2 or f.size == 0:
        raise ValueError(f"expected (H, W), not {f.shape}")
    H, W = f.shape
    right = f.astype(float).ravel() - f.mean(dtype=float)
    u = np.zeros(H * W)
    if u.size > 1:
        A = sparse.kron(second_difference(H), sparse.eye_array(W)) + sparse.kron(
            sparse.eye_array(H), second_difference(W)
        )
        u[1:] = spsolve(A.tocsc()[1:, 1:], right[1:])
    u -= u.mean()
    return u.reshape(H, W).astype(f.dtype if f.dtype == np.float32 else np.float64)
