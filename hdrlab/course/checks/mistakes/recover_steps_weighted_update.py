"""You weight the update of f. It is a plain mean over the pixels of a level; weights of time and level
bias it."""

import numpy as np

from hdrlab.response import robertson

TASK = "recover_steps"


def recover_steps(Z, times, w, *, smoothness=0.0, tolerance=1e-4, turns=200):
    t, empty = times / times.max(), robertson.empty_levels(np.bincount(Z.ravel(), minlength=256), w)
    f = robertson.line()
    yield f, np.inf, empty
    for _ in range(turns):
        E = robertson.irradiance(Z, t, f, w)
        known = ~np.isnan(E)
        T = np.broadcast_to(t**2, Z[known].shape)
        above = np.bincount(Z[known].ravel(), (E[known, None] * t * T).ravel(), 256)
        with np.errstate(invalid="ignore"):
            f = robertson.fill(above / np.bincount(Z[known].ravel(), T.ravel(), 256), empty)
        f = f / f[128]
        yield f, 0.0, empty
