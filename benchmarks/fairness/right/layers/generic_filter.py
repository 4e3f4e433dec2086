"""scipy.ndimage.generic_filter over a window of 3 sigma, NaN outside the picture."""

import numpy as np
from scipy import ndimage


def layers(lL, *, sigma_s, sigma_r=0.4):
    lL = np.asarray(lL, dtype=np.float64)
    r = max(1, int(round(3 * sigma_s)))
    y, x = np.mgrid[-r : r + 1, -r : r + 1]
    spatial = np.exp(-(y**2 + x**2) / (2 * sigma_s**2)).ravel()
    middle = spatial.size // 2

    def bilateral(values):
        weights = spatial * np.exp(-((values - values[middle]) ** 2) / (2 * sigma_r**2))
        inside = ~np.isnan(values)
        return np.dot(weights[inside], values[inside]) / weights[inside].sum()

    base = ndimage.generic_filter(lL, bilateral, size=2 * r + 1, mode="constant", cval=np.nan)
    detail = lL - base
    return base, detail
