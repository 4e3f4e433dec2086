"""Float64, argsort (stable, first of equally near wins), root of log(sigma) by brentq, spot as its own
function.
"""

import numpy as np
from scipy.optimize import brentq


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    """Return the weights w (H, W) of a disc of the nearest pixels, whose sum is 1."""
    H, W = shape
    dy = np.arange(H)[:, None] + 0.5 - at[0] * H
    dx = np.arange(W)[None, :] + 0.5 - at[1] * W
    count = min(max(1, int(np.rint(share * H * W))), H * W)
    nearest = np.argsort((dy**2 + dx**2).ravel(), kind="stable")[:count]
    w = np.zeros(H * W)
    w[nearest] = 1 / count
    return w.reshape(H, W)


def centre(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    """Return w (H, W), a Gaussian about `at` whose sum is 1: `inside` of it lies on the pixels of a spot."""
    H, W = shape
    disc = spot(shape, at=at, share=share) > 0
    y = (np.arange(H)[:, None] + 0.5) / H - at[0]
    x = (np.arange(W)[None, :] + 0.5) / W - at[1]
    d2 = y**2 + x**2
    d2 = d2 - d2.min()  # the same factor for all pixels; keeps exp from 0 / 0

    def weights(log_sigma):
        w = np.exp(-d2 / (2 * np.exp(2 * log_sigma)))
        return w / w.sum()

    def miss(log_sigma):
        return weights(log_sigma)[disc].sum() - inside

    low, high = np.log(1e-7), np.log(1e4)
    if miss(high) >= 0:  # the widest is already too narrow
        return weights(high)
    if miss(low) <= 0:
        return weights(low)
    return weights(brentq(miss, low, high, xtol=1e-14, rtol=1e-14))
