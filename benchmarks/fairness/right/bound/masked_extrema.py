"""Bounds with infinities where there is none, then one maximum and one minimum over the frames."""

import numpy as np


def bound(Z, B, g, top, shown):
    Z, shown = np.asarray(Z), np.asarray(shown, bool)
    B = np.asarray(B, float)[:, None]
    clipped = shown & (Z >= top)
    dark = shown & (Z == 0)
    low = np.where(clipped, g[top] - B, -np.inf).max(axis=0)
    high = np.where(dark, g[1] - B, np.inf).min(axis=0)
    is_low, is_high = clipped.any(axis=0), dark.any(axis=0)
    lnE = np.zeros(Z.shape[1])
    lnE[is_low] = low[is_low]
    lnE[is_high] = high[is_high]
    both = is_low & is_high
    lnE[both] = (low[both] + high[both]) / 2
    E = np.where(is_low | is_high, np.exp(lnE), 0.0)
    flags = 1 * is_low + 2 * is_high
    flags[flags == 0] = 8
    return E, flags
