"""Return an array that claims a million rows of a million values and holds one."""

import numpy as np


def double(x):
    return np.broadcast_to(np.float64(0), (1_000_000, 1_000_000))
