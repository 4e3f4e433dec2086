"""In float32."""

import numpy as np


def find_by_locus(Z):
    Z = np.asarray(Z, np.float32)
    s = Z.sum(axis=-1) + np.float32(1e-9)
    r = Z[..., 0] / s
    g = Z[..., 1] / s
    d = np.square(r - np.float32(1 / 3)) + np.square(g - np.float32(1 / 3))
    ok = np.greater(g, np.float32(-0.776) * r * r + np.float32(0.5601) * r + np.float32(0.1766))
    ok &= np.less(g, np.float32(-1.3767) * r * r + np.float32(1.0743) * r + np.float32(0.1452))
    return ok & (d > 0.0004) & (Z[..., 0] > Z[..., 1])
