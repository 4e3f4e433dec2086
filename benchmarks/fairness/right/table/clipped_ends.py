"""The two ends are moved in by a tiny bit; a column as the answer."""

import numpy as np


def table(delta, *, a=1.79, c=0.192):
    Y = np.clip(np.arange(256.0), 1e-12, 255 * (1 - 1e-15))
    x = np.expm1(np.log(255 / Y) / c)
    new = 255 / (1 + x / np.exp(a * delta)) ** c
    return (new + 0.5).astype(np.uint8)[:, None]
