"""scipy finds the width."""

import numpy as np
from scipy.optimize import brentq


def centre(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    H, W = shape
    down = (np.arange(H) + 0.5) / H - at[0]
    right = (np.arange(W) + 0.5) / W - at[1]
    d2 = down[:, None] ** 2 + right[None, :] ** 2
    pixels = (H * down[:, None]) ** 2 + (W * right[None, :]) ** 2
    nearest = np.argsort(pixels, axis=None)[: int(share * H * W + 0.5)]

    def weights(sigma):
        w = np.exp(-d2 / (2 * sigma**2))
        return w / w.sum()

    sigma = brentq(lambda sigma: weights(sigma).ravel()[nearest].sum() - inside, 0.02, 50)
    return weights(sigma)
