"""scipy.ndimage.gaussian_filter as it comes (edges reflected); an eighth of the longer side if not given."""

import numpy as np
from scipy import ndimage


def scale(L, *, headroom=8.0, sigma=None):
    L = np.asarray(L, dtype=np.float64)
    if sigma is None:
        sigma = max(L.shape) / 8
    with np.errstate(divide="ignore"):
        return 1 / (headroom * ndimage.gaussian_filter(L, sigma))
