"""By the shortest clipped and the longest dark frame; uint8 flags."""

import numpy as np


def bound(Z, B, g, top, shown):
    short = np.min(np.where(shown & (Z >= top), B[:, None], np.inf), axis=0)
    long = np.max(np.where(shown & (Z == 0), B[:, None], -np.inf), axis=0)
    flags = (1 * np.isfinite(short) + 2 * np.isfinite(long)).astype(np.uint8)
    least, most = np.exp(g[top] - short), np.exp(g[1] - long)
    with np.errstate(invalid="ignore", over="ignore"):
        E = np.select([flags == 3, flags == 1, flags == 2], [np.sqrt(least * most), least, most], 0)
    flags[flags == 0] = 8
    return E.astype(np.float32), flags
