"""Differences sorted and cut at -sigma, 0 and sigma by searchsorted; each segment is remapped as a slice,
then put back in its place."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    lL = np.asarray(lL, dtype=float)
    x = (lL - g).ravel()
    order = np.argsort(x, kind="stable")
    s = x[order]
    low = np.searchsorted(s, -sigma, side="left")
    middle = np.searchsorted(s, 0.0, side="left")
    high = np.searchsorted(s, sigma, side="right")
    small = s[low:high]
    f = (np.abs(small) / sigma) ** alpha
    if alpha < 1:
        y = np.clip(np.abs(small) / 0.01 - 1, 0, 1)
        tau = y**2 * (y - 2) ** 2
        f = tau * f + (1 - tau) * np.abs(small) / sigma
    out = np.concatenate(
        [
            -(sigma + beta * (-s[:low] - sigma)),
            -sigma * f[: middle - low],
            sigma * f[middle - low :],
            sigma + beta * (s[high:] - sigma),
        ]
    )
    r = np.empty_like(x)
    r[order] = out
    return g + r.reshape(lL.shape)
