import numpy as np


def log_average(L, *, delta=1e-6):
    L = np.asarray(L, dtype=np.float64)
    positive = L[L > 0]
    if positive.size == 0:
        return 0.0
    d = delta * np.median(positive)
    return float(np.exp(np.average(np.log(d + L))))
