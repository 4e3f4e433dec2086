"""A wrong log_average: linear."""

import numpy as np

TASK = "log_average"
MISCONCEPTION = (
    "This is the mean of L itself: one lamp decides how bright the whole scene counts. Take the mean of "
    "the logarithms."
)


def log_average(L, *, delta=1e-6):
    return float(np.mean(L + delta))
