"""argpartition, halves rounded up, divided by the sum."""

import numpy as np


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    H, W = shape
    d = np.hypot((np.arange(H) + 0.5 - at[0] * H)[:, None], np.arange(W) + 0.5 - at[1] * W).ravel()
    k = min(max(int(np.floor(share * (H * W) + 0.5)), 1), H * W)
    w = np.zeros(H * W)
    w[np.argpartition(d, k - 1)[:k]] = 1.0
    return (w / w.sum()).reshape(H, W)
