"""The brightest pixel is taken for white."""

import numpy as np


def fit_channel_scales(I, M):
    k = 1 / I[np.argmax(M.sum(axis=1))]
    return k / k[1]
