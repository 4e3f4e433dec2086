"""As it is on the sheet, with a guard against 0."""

import numpy as np


def find_by_locus(Z):
    total = Z.sum(axis=-1)
    total = np.where(total == 0, 1, total)
    r, g = Z[..., 0] / total, Z[..., 1] / total
    low = -0.776 * r**2 + 0.5601 * r + 0.1766
    high = -1.3767 * r**2 + 1.0743 * r + 0.1452
    white = (r - 1 / 3) ** 2 + (g - 1 / 3) ** 2 <= 0.0004
    return (low < g) & (g < high) & ~white & (r > g)
