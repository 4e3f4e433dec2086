"""Of pixels equally near the last (bottom right) are taken into the disc; no shift of the exponent; full
bracket by doubling.
"""

import numpy as np
from scipy.optimize import root_scalar


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    """Return the weights w (H, W) of a disc of the nearest pixels, whose sum is 1."""
    H, W = shape
    y, x = np.meshgrid(np.arange(H) + 0.5, np.arange(W) + 0.5, indexing="ij")
    distance = np.sqrt((y - H * at[0]) ** 2 + (x - W * at[1]) ** 2)
    count = min(max(int(np.round(share * H * W)), 1), H * W)
    backwards = distance.ravel()[::-1]
    w = np.zeros(H * W)
    w[np.argsort(backwards, kind="stable")[:count]] = 1
    w = w[::-1].reshape(H, W)
    return w / w.sum()


def centre(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    """Return w (H, W), a Gaussian about `at` whose sum is 1: `inside` of it lies on the pixels of a spot."""
    H, W = shape
    disc = np.sign(spot(shape, at=at, share=share))
    y, x = np.meshgrid(np.arange(H) + 0.5, np.arange(W) + 0.5, indexing="ij")
    d2 = ((y - H * at[0]) / H) ** 2 + ((x - W * at[1]) / W) ** 2

    def gaussian(sigma):
        w = np.exp(-0.5 * d2 / sigma**2)
        return w / w.sum()

    def miss(sigma):
        return (gaussian(sigma) * disc).sum() - inside

    if disc.mean() >= inside:
        return np.full((H, W), 1 / (H * W))
    wide = 1.0
    while miss(wide) > 0:
        wide *= 2
    narrow = wide / 2
    while miss(narrow) < 0:
        narrow /= 2
    found = root_scalar(miss, bracket=(narrow, wide), method="brentq", xtol=1e-15, rtol=1e-14)
    return gaussian(found.root)
