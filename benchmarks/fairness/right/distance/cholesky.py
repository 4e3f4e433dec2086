"""The length after the Cholesky factor is solved."""

import numpy as np
from scipy.linalg import solve_triangular


def distance(Z, skin):
    mu, S = skin[0], skin[1]
    R, G, B = np.moveaxis(Z, -1, 0)
    Y = 0.299 * R + 0.587 * G + 0.114 * B
    Y = np.where(Y < 1, 1, Y)
    Cb = -0.168736 * R - 0.331264 * G + 0.5 * B
    Cr = 0.5 * R - 0.418688 * G - 0.081312 * B
    x = np.stack([(128 * Cb / Y - mu[0]).ravel(), (128 * Cr / Y - mu[1]).ravel()])
    return np.linalg.norm(solve_triangular(np.linalg.cholesky(S), x, lower=True), axis=0).reshape(
        R.shape
    )
