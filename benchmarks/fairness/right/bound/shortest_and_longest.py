"""The tightest bound is that of the shortest clipped and of the longest dark frame: sort once, find first."""

import numpy as np


def first(mask, values):
    """Each column's value at the first True of mask, NaN where there is none."""
    return np.where(mask.any(axis=0), values[np.argmax(mask, axis=0)], np.nan)


def bound(Z, B, g, top, shown):
    Z, B, shown = np.asarray(Z), np.asarray(B, np.float64), np.asarray(shown, dtype=bool)
    order = np.argsort(B)
    back = order[::-1]
    low = g[top] - first((shown & (Z >= top))[order], B[order])
    high = g[1] - first((shown & (Z == 0))[back], B[back])
    lnE = np.where(np.isnan(low), high, np.where(np.isnan(high), low, 0.5 * low + 0.5 * high))
    flags = np.isfinite(low).astype(np.int32) + 2 * np.isfinite(high).astype(np.int32)
    unknown = flags == 0
    flags[unknown] = 8
    E = np.exp(lnE)
    E[unknown] = 0
    return E.astype(np.float32), flags
