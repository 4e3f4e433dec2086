"""scipy's null space of cross products."""

import numpy as np
from scipy.linalg import null_space


def homography(source, target):
    m, s = target.mean(axis=0), np.ptp(target)
    rows = []
    for p, q in zip(source, (target - m) / s):
        P = np.array([p[0], p[1], 1.0])
        cross = np.array([[0, -1, q[1]], [1, 0, -q[0]]])
        rows.append(np.kron(cross, P))
    h = null_space(np.vstack(rows), rcond=1e-10)[:, -1].reshape(3, 3)
    H = np.array([[s, 0, m[0]], [0, s, m[1]], [0, 0, 1]]) @ h
    return H / H[2, 2]
