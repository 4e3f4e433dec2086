"""A kernel convolved with a border that wraps around, and a trace in all pixels."""

import numpy as np
from scipy.ndimage import convolve


def weight(F, powers=(1, 1, 1)):
    a, b, c = powers
    kernel = np.array([[0, 1, 0], [1, -4, 1], [0, 1, 0]], float)
    gray = np.einsum("c,cyx->yx", [0.299, 0.587, 0.114], F)
    W = np.abs(convolve(gray, kernel, mode="wrap")) ** a
    W = W * np.std(F, axis=0) ** b
    W = W * np.exp(-0.5 * np.sum(((F - 0.5) / 0.2) ** 2, axis=0)) ** c
    return W + 1e-9
