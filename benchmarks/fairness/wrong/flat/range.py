"""The range of a patch, within four deviations; the edge is left out."""

import numpy as np
from scipy.ndimage import maximum_filter, minimum_filter


def flat(A, *, size=5, psi=0.05, sigma=0.01):
    mean, r = A.mean(axis=0), size // 2
    found = maximum_filter(mean, size) - minimum_filter(mean, size) < 4 * sigma
    return np.pad(found[r:-r, r:-r], r)
