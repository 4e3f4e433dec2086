"""You weight the update of f^-1. It is a plain mean over the pixels of a level; weights of time and level
bias it."""

import numpy as np

from hdrlab.response import robertson


def recover_steps(Z, times, w, *, tolerance=1e-4, max_iterations=200):
    t = times / times.max()
    f_inv = robertson.linear()
    yield f_inv, np.inf
    for _ in range(max_iterations):
        E = robertson.irradiance(Z, t, f_inv, w)
        known = ~np.isnan(E)
        T = np.broadcast_to(t**2, Z[known].shape)
        above = np.bincount(Z[known].ravel(), (E[known, None] * t * T).ravel(), 256)
        with np.errstate(invalid="ignore"):
            f_inv = robertson.fill(above / np.bincount(Z[known].ravel(), T.ravel(), 256), w)
        f_inv = f_inv / f_inv[128]
        yield f_inv, 0.0
