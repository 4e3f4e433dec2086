"""ln((255 / Y)^(1 / C) - 1) with expm1, as an array of one number."""

import numpy as np


def offset(average, target=128.0, *, a=1.79, c=0.192):
    Y = np.clip([target, average], 1e-30, 255 - 1e-13)
    q = -np.log(np.expm1(np.log(255 / Y) / c)) / a
    return np.clip(q[:1] - q[1:], -8, 8)
