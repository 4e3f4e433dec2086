"""A table of the 256 codes, then an index."""

import numpy as np


def exclusion(Y, t):
    table = np.array([abs(code - float(t)) > 4 for code in range(256)])
    return table[np.asarray(Y, dtype=np.uint8)]
