"""You stopped at the mean of the logarithms: take exp of it, so that Lav has the unit of L."""

import numpy as np


def log_average(L, *, delta=1e-6):
    return float(np.log(L + delta).mean(dtype=float))
