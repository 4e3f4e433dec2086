"""The class of a pixel from its rank."""

import numpy as np
from scipy.stats import rankdata


def spread(L, Ld, bins=64):
    k = ((rankdata(L, method="ordinal").ravel() - 1) * bins // L.size).astype(int)
    l, d = L.flatten(), Ld.flatten()
    low, high = np.full(bins, np.inf), np.full(bins, -np.inf)
    np.minimum.at(low, k, d)
    np.maximum.at(high, k, d)
    return [np.median(l[k == j]) for j in range(bins)], low, high
