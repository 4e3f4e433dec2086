"""ufunc.reduce with where= and initial=, and flags put together by bits."""

import numpy as np


def bound(Z, B, g, top, shown):
    Z = np.asarray(Z)
    shown = np.asarray(shown, dtype=bool)
    lower = np.broadcast_to((float(g[top]) - np.asarray(B, dtype=float))[:, np.newaxis], Z.shape)
    upper = np.broadcast_to((float(g[1]) - np.asarray(B, dtype=float))[:, np.newaxis], Z.shape)
    clipped = np.logical_and(Z >= top, shown)
    dark = np.logical_and(Z < 1, shown)
    tight_low = np.maximum.reduce(lower, axis=0, where=clipped, initial=-np.inf)
    tight_high = np.minimum.reduce(upper, axis=0, where=dark, initial=np.inf)
    flags = np.bitwise_or(clipped.any(0).astype(np.uint8), dark.any(0).astype(np.uint8) << 1)
    count = clipped.any(0).astype(int) + dark.any(0)
    total = np.where(clipped.any(0), tight_low, 0) + np.where(dark.any(0), tight_high, 0)
    E = np.exp(total / np.maximum(count, 1)) * (count > 0)
    return E, np.where(flags == 0, np.uint8(8), flags)
