"""The edge repeated, and the difference scaled."""

import numpy as np
from scipy import ndimage


def fix_uncertain(mean, k, *, sigma_s):
    blur = ndimage.gaussian_filter(mean.astype(float), sigma=2, mode="nearest", truncate=3)
    certainty = np.minimum(1, np.maximum(0, 2 * np.log(k) / np.log(2 * np.pi * sigma_s**2)))
    return blur + certainty * (mean - blur)
