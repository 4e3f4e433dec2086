"""Every pixel begins with a number of its own, and the largest one spreads; floats come back."""

import numpy as np
from scipy.ndimage import maximum_filter


def label(mask):
    own = np.where(mask, np.arange(1, mask.size + 1).reshape(mask.shape), 0)
    while True:
        wider = np.where(mask, maximum_filter(own, size=3), 0)
        if np.array_equal(wider, own):
            break
        own = wider
    values = np.unique(own[mask])
    return np.where(mask, np.searchsorted(values, own) + 1, 0).astype(float)
