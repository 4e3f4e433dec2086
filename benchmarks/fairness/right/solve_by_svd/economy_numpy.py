import numpy as np


def solve_by_svd(A, b, *, rtol=1e-10):
    U, s, Vt = np.linalg.svd(np.asarray(A, float), full_matrices=False)
    keep = s > rtol * s[0]
    return Vt[keep].T @ ((U[:, keep].T @ np.asarray(b, float)) / s[keep])
