"""The Gaussian is separable, an outer product of two 1-D Gaussians; root sought in 1 / (2 sigma^2); half
up.
"""

import numpy as np
from scipy.optimize import brentq


def centre(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    """Return w (H, W), a Gaussian about `at` whose sum is 1: `inside` of it lies on the pixels of a spot."""
    H, W = shape
    v = (np.arange(H) + 0.5) / H - at[0]
    u = (np.arange(W) + 0.5) / W - at[1]
    r2 = np.add.outer((v * H) ** 2, (u * W) ** 2)
    count = min(max(int(share * H * W + 0.5), 1), H * W)
    disc = np.zeros(H * W)
    disc[np.argsort(r2, axis=None, kind="stable")[:count]] = 1
    disc = disc.reshape(H, W)
    v2 = v**2 - np.min(v**2)
    u2 = u**2 - np.min(u**2)

    def sides(b):
        a, c = np.exp(-b * v2), np.exp(-b * u2)
        return a / a.sum(), c / c.sum()

    def miss(b):
        a, c = sides(b)
        return a @ disc @ c - inside

    if miss(0.0) >= 0:
        return np.full((H, W), 1 / (H * W))
    top = 1.0
    while miss(top) < 0 and top < 1e12:
        top *= 4
    b = brentq(miss, 0.0, top, xtol=1e-13, rtol=1e-14, maxiter=500) if miss(top) > 0 else top
    return np.outer(*sides(b))
