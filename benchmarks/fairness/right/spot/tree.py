"""scipy's tree of the middles asked for the k nearest."""

import numpy as np
from scipy.spatial import cKDTree


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    H, W = shape
    middles = np.argwhere(np.ones((H, W), bool)) + 0.5
    k = min(max(int(np.round(share * H * W)), 1), H * W)
    _, i = cKDTree(middles).query((at[0] * H, at[1] * W), k=k)
    w = np.zeros(H * W)
    w[np.atleast_1d(i)] = 1.0 / k
    return w.reshape(H, W)
