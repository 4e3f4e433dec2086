import numpy as np


def weighted_variance(x, w):
    """One photograph after the other (West 1979)."""
    x = np.asarray(x, dtype=np.float64)
    w = np.asarray(w, dtype=np.float64)
    total = np.zeros(x.shape[1:])
    mean = np.zeros(x.shape[1:])
    S = np.zeros(x.shape[1:])
    for xj, wj in zip(x, w):
        on = wj > 0
        new = total + wj
        d = np.where(on, xj - mean, 0.0)
        r = np.divide(wj, new, out=np.zeros_like(new), where=on)
        S = S + total * d * d * r
        mean = mean + d * r
        total = new
    return np.divide(S, total, out=np.zeros_like(S), where=total > 0)
