"""numpy's sliding windows over the picture continued by its last pixels; np.var of each."""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view


def windows(x, r):
    return sliding_window_view(np.pad(x, r, mode="edge"), (2 * r + 1, 2 * r + 1)).reshape(*x.shape, -1)


def guided(I, p=None, *, radius, epsilon):
    wI, wp = windows(I, radius), windows(I if p is None else p, radius)
    dI, dp = (w - w.mean(axis=-1, keepdims=True) for w in (wI, wp))
    a = (dI * dp).mean(axis=-1) / (wI.var(axis=-1) + epsilon)
    b = wp.mean(axis=-1) - a * wI.mean(axis=-1)
    return windows(a, radius).mean(axis=-1) * I + windows(b, radius).mean(axis=-1)
