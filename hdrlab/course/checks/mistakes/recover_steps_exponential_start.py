"""The iterations begin with a linear camera. You begin with an exponential, and what the photographs leave
open stays bent like it."""

import numpy as np

from hdrlab.response import robertson


def recover_steps(Z, times, w, *, tolerance=1e-4, max_iterations=200):
    t = times / times.max()
    f_inv = np.exp((np.arange(256) - 128) / 50)
    yield f_inv, np.inf
    for _ in range(max_iterations):
        f_inv = robertson.fill(robertson.update(Z, t, robertson.irradiance(Z, t, f_inv, w)), w)
        f_inv = f_inv / f_inv[128]
        yield f_inv, 0.0
