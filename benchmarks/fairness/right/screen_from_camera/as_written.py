"""The formulas as they stand."""

import numpy as np


def screen_from_camera(M, P):
    A = M @ P
    return np.linalg.inv(A / A.sum(axis=1, keepdims=True))
