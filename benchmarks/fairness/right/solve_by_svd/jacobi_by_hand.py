import numpy as np


def solve_by_svd(A, b, *, rtol=1e-10):
    """One-sided Jacobi on R of A = Q R: rotate columns until all are orthogonal."""
    Q, B = np.linalg.qr(np.array(A, dtype=float))
    c = Q.T @ np.asarray(b, float)
    k = B.shape[1]
    V = np.eye(k)
    floor = (1e-16 * np.linalg.norm(B)) ** 2
    for _ in range(60):
        turned = False
        for p in range(k - 1):
            for q in range(p + 1, k):
                al, be, ga = B[:, p] @ B[:, p], B[:, q] @ B[:, q], B[:, p] @ B[:, q]
                if abs(ga) <= 1e-15 * np.sqrt(al * be) or abs(ga) <= floor:
                    continue
                turned = True
                z = (be - al) / (2 * ga)
                t = (1.0 if z >= 0 else -1.0) / (abs(z) + np.hypot(1, z))
                co = 1 / np.hypot(1, t)
                rot = np.array([[co, co * t], [-co * t, co]])
                B[:, [p, q]] = B[:, [p, q]] @ rot
                V[:, [p, q]] = V[:, [p, q]] @ rot
        if not turned:
            break
    s = np.linalg.norm(B, axis=0)
    x = np.zeros(k)
    for i in range(k):
        if s[i] > rtol * s.max():
            x += (B[:, i] @ c) / s[i] ** 2 * V[:, i]
    return x
