import numpy as np


def log_average(L, *, delta=1e-6):
    return np.mean(delta * np.median(L[L > 0]) + L) if np.any(L > 0) else 0.0
