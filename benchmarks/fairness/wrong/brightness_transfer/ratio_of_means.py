"""A straight line through 0, as steep as the means are apart."""

import numpy as np


def brightness_transfer(h_A, h_B):
    z = np.arange(len(h_A))
    T = z * (np.sum(z * h_B) / np.sum(h_B)) / (np.sum(z * h_A) / np.sum(h_A))
    return np.where((T > 0.5) & (T < len(z) - 1.5), T, np.nan)
