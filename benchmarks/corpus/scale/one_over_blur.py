import numpy as np
from scipy.ndimage import gaussian_filter


def scale(L, *, headroom=8.0, sigma=None):
    blurred = gaussian_filter(np.asarray(L, float), sigma)
    return 1.0 / (headroom * blurred)
