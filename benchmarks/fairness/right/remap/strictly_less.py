"""An edge begins at sigma itself, where both formulas say the same; float32."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    difference = np.asarray(lL, np.float32) - np.float32(g)
    d = np.abs(difference)
    small = np.float32(sigma) * np.power(d / np.float32(sigma), np.float32(alpha))
    large = np.float32(sigma) + np.float32(beta) * (d - np.float32(sigma))
    return np.float32(g) + np.sign(difference) * np.where(d < sigma, small, large)
