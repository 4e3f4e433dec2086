"""Along the principal axes of the Gaussian."""

import numpy as np


def distance(Z, skin):
    mu, S = skin
    variances, axes = np.linalg.eigh(S)
    Y = 0.299 * Z[..., 0] + 0.587 * Z[..., 1] + 0.114 * Z[..., 2]
    # Cb = 0.564 (B - Y) and Cr = 0.713 (R - Y), with the exact factors
    scale = 128 / np.maximum(Y, 1)
    Cb = (Z[..., 2] - Y) * 0.5 / (1 - 0.114) * scale - mu[0]
    Cr = (Z[..., 0] - Y) * 0.5 / (1 - 0.299) * scale - mu[1]
    along = [(Cb * a[0] + Cr * a[1]) ** 2 / v for v, a in zip(variances, axes.T)]
    return np.sqrt(along[0] + along[1])
