"""scipy's filter of maxima."""

import numpy as np
from scipy.ndimage import maximum_filter


def peaks(c, count):
    places = np.argwhere((maximum_filter(c, size=5) == c) & (c > 0))
    order = np.argsort([c[tuple(p)] for p in places])[::-1]
    return places[order[:count]] - [c.shape[0] // 2, c.shape[1] // 2]
