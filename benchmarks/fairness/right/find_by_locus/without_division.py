"""The inequalities, multiplied by the squared sum."""

import numpy as np


def find_by_locus(Z):
    R, G, B = (Z[..., k] for k in range(3))
    S = R + G + B
    low = G * S > -0.776 * R * R + 0.5601 * R * S + 0.1766 * S * S
    high = G * S < -1.3767 * R * R + 1.0743 * R * S + 0.1452 * S * S
    far = (3 * R - S) ** 2 + (3 * G - S) ** 2 > 0.0036 * S * S
    return np.logical_and.reduce([low, high, far, R > G])
