import numpy as np


def log_average(L, *, delta=1e-6):
    N = L.size
    total = 0.0
    for value in np.ravel(L):
        total += np.log(delta + float(value))
    return np.exp(total / N)
