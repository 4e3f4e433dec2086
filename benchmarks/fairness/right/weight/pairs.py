"""Saturation from the three differences of channels, contrast as sum of differences, none at the edge."""

import numpy as np


def weight(F, powers=(1, 1, 1)):
    R, G, B = np.asarray(F, float)
    Y = 0.299 * R + 0.587 * G + 0.114 * B
    C = np.zeros(Y.shape)
    down, right = np.diff(Y, axis=0), np.diff(Y, axis=1)
    C[:-1] += down
    C[1:] -= down
    C[:, :-1] += right
    C[:, 1:] -= right
    S = np.sqrt((R - G) ** 2 + (G - B) ** 2 + (B - R) ** 2) / 3
    E = (
        np.exp(-12.5 * (R - 0.5) ** 2)
        * np.exp(-12.5 * (G - 0.5) ** 2)
        * np.exp(-12.5 * (B - 0.5) ** 2)
    )
    W = np.ones(Y.shape)
    for x, p in zip((np.abs(C), S, E), powers):
        if p:
            W = W * x**p
    return W
