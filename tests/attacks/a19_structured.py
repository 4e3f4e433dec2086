"""Return an array of records, and one of dates."""

import numpy as np


def double(x):
    return np.zeros(x.shape, dtype=[("a", "f8"), ("b", "O")]), np.zeros(3, "M8[s]")
