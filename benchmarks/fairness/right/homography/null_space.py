"""The direct linear transform: nine unknowns, the last singular vector, after centering."""

import numpy as np


def normalizer(p):
    m, s = p.mean(axis=0), p.std()
    return np.array([[1 / s, 0, -m[0] / s], [0, 1 / s, -m[1] / s], [0, 0, 1]])


def homography(source, target):
    N, T = normalizer(source), normalizer(target)
    one = np.ones((4, 1))
    p, q = np.hstack([source, one]) @ N.T, np.hstack([target, one]) @ T.T
    zero = np.zeros((4, 3))
    A = np.vstack([np.hstack([p, zero, -q[:, :1] * p]), np.hstack([zero, p, -q[:, 1:2] * p])])
    h = np.linalg.svd(A)[2][-1].reshape(3, 3)
    H = np.linalg.inv(T) @ h @ N
    return H / H[2, 2]
