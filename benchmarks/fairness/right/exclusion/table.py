"""By a table of the codes."""

import numpy as np


def exclusion(Y, t):
    table = np.ones(256, bool)
    table[max(0, t - 4) : t + 5] = False
    return table[Y]
