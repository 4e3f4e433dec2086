"""The bare curve, nearest and the upper of two."""

import numpy as np


def recover_steps(Z, times, w, *, tolerance=1e-4, max_iterations=200):
    t, level = np.asarray(times, float), np.arange(256)
    f = level / 128.0
    yield f.astype(np.float32)
    for _ in range(max_iterations):
        with np.errstate(invalid="ignore"):
            E = ((w * f)[Z] @ t) / (w[Z] @ t**2)
        ok = np.isfinite(E)
        z, X = Z[ok].ravel(), (E[ok, None] * t).ravel()
        with np.errstate(invalid="ignore"):
            new = np.bincount(z, X, 256) / np.bincount(z, minlength=256)
        have = np.flatnonzero(np.isfinite(new))
        new = new[have[::-1][np.abs(level[:, None] - have[::-1]).argmin(axis=1)]]
        new = new / new[128]
        change, f = np.abs(new - f).max(), new
        yield f.astype(np.float32)
        if change < tolerance:
            return
