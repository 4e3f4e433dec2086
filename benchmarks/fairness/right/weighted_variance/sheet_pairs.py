import numpy as np


def weighted_variance(x, w):
    """v = sum_{i<j} w_i w_j (x_i - x_j)^2 / (sum w)^2, the same number."""
    x = np.asarray(x, dtype=np.float64)
    w = np.asarray(w, dtype=np.float64)
    total = w.sum(0)
    p = np.divide(w, total, out=np.zeros_like(w), where=np.broadcast_to(total > 0, w.shape))
    v = np.zeros(x.shape[1:])
    for i in range(len(x)):
        for j in range(i + 1, len(x)):
            v += p[i] * p[j] * (x[i] - x[j]) ** 2
    return v
