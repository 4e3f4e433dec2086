"""Wrong: a plain Gaussian blur in place of the bilateral filter; sigma_r is not used."""

import numpy as np
from scipy.ndimage import gaussian_filter


def layers(lL, *, sigma_s, sigma_r=0.4):
    lL = np.asarray(lL, dtype=float)
    base = gaussian_filter(lL, sigma_s)
    return base, lL - base
