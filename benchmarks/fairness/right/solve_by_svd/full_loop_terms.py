import numpy as np


def solve_by_svd(A, b, *, rtol=1e-10):
    A = np.asarray(A, dtype=np.float64)
    b = np.asarray(b, dtype=np.float64).ravel()
    U, s, Vt = np.linalg.svd(A, full_matrices=True)
    x = np.zeros(A.shape[1])
    for i in range(len(s)):
        if s[i] > rtol * s.max():
            x += (U[:, i] @ b) / s[i] * Vt[i]
    return x
