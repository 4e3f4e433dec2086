"""You did not divide by the sum of the weights: where few neighbours are alike the base is too small."""

import numpy as np

from hdrlab.core.filters.bilateral import bilateral


def layers(lL, *, sigma_s, sigma_r=0.4):
    mean, k = bilateral(lL, sigma_s=sigma_s, sigma_r=sigma_r)
    base = mean * k / (2 * np.pi * sigma_s**2)
    return base, lL - base
