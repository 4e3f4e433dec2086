"""NaN where G is 0, and nanquantile."""

import numpy as np


def lowest_ratio(F, G):
    if np.count_nonzero(G) < 5000:
        return 0.0, np.inf
    ratios = np.full(F.shape, np.nan)
    np.divide(F, G, out=ratios, where=G > 0)
    low, higher, high = (np.nanquantile(ratios, p) for p in (2e-4, 1e-3, 1e-2))
    extrapolated = low - (higher - low)
    return (extrapolated if extrapolated > 0 else 0.0), high / low
