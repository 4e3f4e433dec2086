"""A spread of less than two deviations of the noise."""

import numpy as np
from scipy.ndimage import generic_filter


def flat(A, *, size=5, psi=0.05, sigma=0.01):
    return generic_filter(A.mean(axis=0), np.std, size=size) < 2 * sigma
