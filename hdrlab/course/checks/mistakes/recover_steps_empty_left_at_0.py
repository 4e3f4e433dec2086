"""Levels without pixels stay 0 in your response. They lie between their neighbours: fill them, or later
iterations read 0 there."""

import numpy as np

from hdrlab.response import robertson


def recover_steps(Z, times, w, *, tolerance=1e-4, max_iterations=200):
    t = times / times.max()
    f_inv = robertson.linear()
    yield f_inv, np.inf
    for _ in range(max_iterations):
        f_inv = np.nan_to_num(robertson.update(Z, t, robertson.irradiance(Z, t, f_inv, w)))
        f_inv = f_inv / (f_inv[128] or 1)
        yield f_inv, 0.0
