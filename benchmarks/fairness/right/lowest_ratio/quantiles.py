"""numpy's quantiles of the ratios."""

import numpy as np


def lowest_ratio(F, G):
    ok = G > 0
    if ok.sum() < 5000:
        return 0, np.inf
    q1, q2, q3 = np.quantile(F[ok] / G[ok], [0.0002, 0.001, 0.01])
    return max(0, 2 * q1 - q2), q3 / q1
