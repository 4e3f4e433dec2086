"""scipy's quantiles with the parameters of numpy's."""

import numpy as np
from scipy.stats.mstats import mquantiles


def lowest_ratio(F, G):
    positive = G > 0
    if positive.sum() < 5000:
        return 0.0, np.inf
    ratios = np.compress(positive.ravel(), F.ravel().astype(float)) / G[positive]
    q = np.asarray(mquantiles(ratios, [0.0002, 0.001, 0.01], alphap=1, betap=1))
    return max(2 * q[0] - q[1], 0), q[2] / q[0]
