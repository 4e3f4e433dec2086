"""Shares of each frame first, in float32."""

import numpy as np


def weighted_variance(x, w):
    x, w = np.float32(x), np.float32(w)
    share = w / np.maximum(w.sum(0, keepdims=True), np.float32(1e-20))
    mean = np.einsum("phw,phw->hw", share, x)
    return np.einsum("phw,phw->hw", share, np.square(x - mean))
