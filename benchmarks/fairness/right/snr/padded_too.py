"""Curve and levels padded with their ends, differences of shifted slices."""

import numpy as np


def snr(g, *, least=0.01, span=4):
    g = np.asarray(g, float)
    f = np.exp(g - g[-1])
    n = f.size
    F, Z = np.pad(f, span, mode="edge"), np.pad(np.arange(n), span, mode="edge")
    slope = (F[2 * span :] - F[: -2 * span]) / (Z[2 * span :] - Z[: -2 * span])
    w = f / np.fmax(slope, least * (f[-1] - f[0]) / (n - 1))
    w[0] = w[-1] = 0
    return w
