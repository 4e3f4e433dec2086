"""Convolution with a kernel of ones, symmetric at the edges; float32, a list of lists."""

import numpy as np
from scipy.signal import convolve2d


def guided(I, p=None, *, radius, epsilon):
    I = np.asarray(I, np.float32)
    p = I if p is None else np.asarray(p, np.float32)
    kernel = np.ones((2 * radius + 1, 2 * radius + 1), np.float32)
    kernel /= kernel.sum()

    def mean(x):
        return convolve2d(x, kernel, mode="same", boundary="symm")

    a = (mean(I * p) - mean(I) * mean(p)) / (mean(I * I) - mean(I) ** 2 + np.float32(epsilon))
    b = mean(p) - a * mean(I)
    return (mean(a) * I + mean(b)).tolist()
