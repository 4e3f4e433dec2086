"""np.interp over levels that are moved by a half afterwards, in float32."""

import numpy as np


def brightness_transfer(h_A, h_B):
    n = np.size(h_B)

    def cumulate(h):
        return np.insert(np.cumsum(h), 0, 0) / np.sum(h)

    middle = np.convolve(cumulate(h_A), [0.5, 0.5], "valid")
    T = (np.interp(middle, cumulate(h_B), np.arange(n + 1)) - 0.5).astype(np.float32)
    return np.where((T < 0.5) | (T > n - 1.5), np.float32(np.nan), T)
