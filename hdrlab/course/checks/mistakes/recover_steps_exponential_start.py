"""The turns begin with a linear camera. You begin with an exponential, and what the photographs leave
open stays bent like it."""

import numpy as np

from hdrlab.response import robertson

TASK = "recover_steps"


def recover_steps(Z, times, w, *, smoothness=0.0, tolerance=1e-4, turns=200):
    t, empty = times / times.max(), robertson.empty_levels(np.bincount(Z.ravel(), minlength=256), w)
    f = np.exp((np.arange(256) - 128) / 50)
    yield f, np.inf, empty
    for _ in range(turns):
        f = robertson.fill(robertson.update(Z, t, robertson.irradiance(Z, t, f, w)), empty)
        f = f / f[128]
        yield f, 0.0, empty
