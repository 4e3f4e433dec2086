"""Three standard deviations, joined by hypot and squared; no light counts as below none."""

import numpy as np


def variance(X, D, N, R):
    photons = np.sqrt(np.maximum(X, 0) / N)
    return np.hypot(np.hypot(photons, R / N), D / np.sqrt(12)) ** 2
