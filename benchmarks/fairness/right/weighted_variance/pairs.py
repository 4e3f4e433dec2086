"""Half the weighted mean of the squared differences of all pairs of frames."""

import numpy as np


def weighted_variance(x, w):
    total = np.sum(w, 0)
    v = np.zeros(total.shape)
    for a in range(len(x)):
        for b in range(a):
            v += w[a] * w[b] * (x[a] - x[b]) ** 2
    return np.divide(v, total**2, out=np.zeros_like(v), where=total > 0)
