"""The inverses of the factors, in reverse order."""

import numpy as np


def screen_from_camera(M, P):
    white = (M @ P).sum(axis=1)
    return np.linalg.inv(P) @ np.linalg.inv(M) @ np.diag(white)
