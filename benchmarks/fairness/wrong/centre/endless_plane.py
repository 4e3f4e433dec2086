"""No search: the width for which an endless plane has so much within a circle of that share."""

import numpy as np


def centre(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    """Return w (H, W), a Gaussian about `at` whose sum is 1: `inside` of it lies on the pixels of a spot."""
    H, W = shape
    y = (np.arange(H)[:, None] + 0.5) / H - at[0]
    x = (np.arange(W)[None, :] + 0.5) / W - at[1]
    sigma2 = share / np.pi / (-2 * np.log(1 - inside))
    w = np.exp(-(y**2 + x**2) / (2 * sigma2))
    return w / w.sum()
