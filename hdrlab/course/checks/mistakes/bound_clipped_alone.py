"""You think of clipped pixels alone: one that is dark in all frames is bounded from above, by the longest
of them."""

import numpy as np


def bound(Z, B, g, top, shown):
    clipped, dark = shown & (Z >= top), shown & (Z == 0)
    lower = np.where(clipped, g[top] - B[:, None], -np.inf).max(axis=0)
    return np.exp(lower), clipped.any(axis=0) + 2 * dark.any(axis=0)
