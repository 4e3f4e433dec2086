import numpy as np


def log_average(L, *, delta=1e-6):
    L = np.asarray(L, float)
    d = delta * np.median(L[L > 0])
    return np.exp(np.mean(np.log10(d + L)))
