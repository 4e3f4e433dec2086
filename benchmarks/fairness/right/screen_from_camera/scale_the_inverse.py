"""The inverse of diag(1 / s) A is the inverse of A times diag(s)."""

import numpy as np


def screen_from_camera(M, P):
    A = np.asarray(M) @ np.asarray(P)
    return np.linalg.inv(A) * A.sum(axis=1)
