"""The center of mass of what is positive, again and again."""

import numpy as np
from scipy.ndimage import center_of_mass


def peaks(c, count):
    place = np.rint(center_of_mass(np.maximum(c, 0))).astype(int)
    return np.tile(place - np.array(c.shape) // 2, (count, 1))
