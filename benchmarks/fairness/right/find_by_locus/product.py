"""Products of masks as floats."""

import numpy as np


def find_by_locus(Z):
    s = np.maximum(Z.sum(-1), 1e-12)
    r, g = (Z[..., :2] / s[..., None]).transpose(-1, *range(Z.ndim - 1))
    inside = (g - (0.1766 + r * (0.5601 - 0.776 * r))) * ((0.1452 + r * (1.0743 - 1.3767 * r)) - g)
    mask = 1.0 * (inside > 0)
    mask *= (r - 1 / 3) ** 2 + (g - 1 / 3) ** 2 > 4e-4
    return mask * (r > g)
