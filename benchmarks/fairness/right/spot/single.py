"""In float32, from the index (y, x) to (at H - 1/2, at W - 1/2); later pixels first where equal."""

import numpy as np


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    H, W = shape
    a = np.square(np.arange(H) - (at[0] * H - 0.5))
    b = np.square(np.arange(W) - (at[1] * W - 0.5))
    d = np.add.outer(a, b).ravel()
    k = max(int(share * H * W + 0.5), 1)
    rank = np.empty(d.size, int)
    rank[np.lexsort((-np.arange(d.size), d))] = np.arange(d.size)
    inside = (rank < k).astype(np.float32)
    return (inside / inside.sum()).reshape(H, W)
