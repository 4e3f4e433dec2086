import numpy as np


def solve_by_svd(A, b, *, rtol=1e-10):
    """A = Q R, R = U' S V^T: the singular values of R are those of A, and U = Q U'."""
    Q, R = np.linalg.qr(np.asarray(A, float))
    Ur, s, Vt = np.linalg.svd(R)
    c = Ur.T @ (Q.T @ np.asarray(b, float))
    keep = s > rtol * s[0]
    return (c[keep] / s[keep]) @ Vt[keep]
