"""This is the mean of L itself: one lamp decides how bright the whole scene counts. Take the mean of the
logarithms."""

import numpy as np


def log_average(L, *, delta=1e-6):
    return float(np.mean(L + delta))
