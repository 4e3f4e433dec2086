"""np.choose takes the gain; float32 in the end."""

import numpy as np


def balance_white(X, c, gains):
    g = np.choose(c, [gain / min(gains) for gain in gains])
    return np.minimum(X * g, 1).astype(np.float32)
