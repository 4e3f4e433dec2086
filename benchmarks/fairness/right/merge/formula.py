"""The formula read aloud: all frames at once in float64, NaN where no frame has any weight."""

import numpy as np


def merge(images, times, g, w=None):
    Z = np.asarray(images)
    g = np.asarray(g, dtype=float)
    if w is None:
        z = np.arange(256.0)
        w = np.minimum(z, 255 - z)
    w = np.asarray(w, dtype=float)
    ln_t = np.log(np.asarray(times, dtype=float)).reshape((-1,) + (1,) * (Z.ndim - 1))
    if g.ndim == 2:
        gZ = g[Z, np.arange(g.shape[1])]
    else:
        gZ = g[Z]
    weights = w[Z]
    with np.errstate(invalid="ignore", divide="ignore"):
        lnE = (weights * (gZ - ln_t)).sum(axis=0) / weights.sum(axis=0)
    return np.exp(lnE)
