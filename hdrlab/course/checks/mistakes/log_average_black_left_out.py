"""You take the mean of log L where L is above 0 alone: black pixels are part of the scene, and the delta
is there for them."""

import numpy as np


def log_average(L, *, delta=1e-6):
    return float(np.exp(np.log(L[L > 0]).mean(dtype=float)))
