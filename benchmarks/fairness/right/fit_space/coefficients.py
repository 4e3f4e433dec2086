"""sd as the standard deviation of the coefficients; a class of one's own; other signs."""

from typing import NamedTuple

import numpy as np
from scipy.linalg import svd


class Curves(NamedTuple):
    mean: np.ndarray
    H: np.ndarray
    sd: np.ndarray


def fit_space(curves, count):
    mean = np.average(curves, axis=0)
    H = -svd(curves - mean, full_matrices=False)[2][:count]
    return Curves(mean, H, ((curves - mean) @ H.T).std(axis=0))
