"""Vectorised minimum of both sides, divided by the largest weight: 127 and 128 both get 1."""

import numpy as np


def hat(n=256):
    z = np.arange(n, dtype=np.float64)
    w = np.minimum(z, n - 1 - z)
    return w / max(w.max(), 1.0)
