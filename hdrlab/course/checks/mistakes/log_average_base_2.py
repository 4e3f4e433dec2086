"""You took the logarithm to one base and the power of another: exp belongs to the natural logarithm."""

import numpy as np


def log_average(L, *, delta=1e-6):
    return float(np.exp(np.log2(L + delta).mean(dtype=float)))
