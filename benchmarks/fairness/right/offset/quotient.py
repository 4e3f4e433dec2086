"""One logarithm of a quotient."""

import numpy as np


def offset(average, target=128.0, *, a=1.79, c=0.192):
    p, q = (np.float64(average) / 255) ** (1 / c), (target / 255) ** (1 / c)
    if p in (0, 1):
        return 8 - 16 * p
    return np.clip(np.log(q / (1 - q) * (1 - p) / p) / a, -8, 8)
