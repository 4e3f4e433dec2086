"""In radiances, not logarithms: exp(g) / t, and the geometric mean between two bounds; a list of two."""

import numpy as np


def bound(Z, B, g, top, shown):
    t = np.exp(np.asarray(B, float))
    at_least, at_most = np.exp(g[top]) / t, np.exp(g[1]) / t
    low = np.zeros(np.shape(Z)[1])
    high = np.full(np.shape(Z)[1], np.inf)
    for j in range(len(t)):
        level, visible = np.asarray(Z[j]), np.asarray(shown[j]).astype(bool)
        clipped = visible & (level >= top)
        dark = visible & (level == 0)
        low[clipped] = np.maximum(low[clipped], at_least[j])
        high[dark] = np.minimum(high[dark], at_most[j])
    some_low, some_high = low > 0, high < np.inf
    E = np.select(
        [some_low & some_high, some_low, some_high],
        [np.sqrt(low) * np.sqrt(np.where(some_high, high, 0)), low, high],
        0.0,
    )
    flags = np.select([some_low & some_high, some_low, some_high], [3, 1, 2], 8)
    return [E, flags.astype(np.uint8)]
