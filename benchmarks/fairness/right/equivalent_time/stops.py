"""In stops."""

import numpy as np


def equivalent_time(T, F, F_new, *, S=100, S_new=100):
    stops = 2 * np.log2(F_new / F) + np.log2(S / S_new)
    return float(T) * 2.0**stops
