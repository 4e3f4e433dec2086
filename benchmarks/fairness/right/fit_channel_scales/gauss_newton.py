"""Gauss and Newton's steps by hand, with the derivative of a direction, from the median quotient."""

import numpy as np


def fit_channel_scales(I, M):
    I, M = np.asarray(I, float), np.asarray(M, float)
    t = M / np.linalg.norm(M, axis=1)[:, None]
    q = np.median(M / I / (M[:, 1:2] / I[:, 1:2]), axis=0)
    x = np.log(q[[0, 2]])

    def residual(x):
        a = I * np.exp([x[0], 0, x[1]])
        return a / np.linalg.norm(a, axis=1)[:, None] - t

    for _ in range(60):
        r = residual(x)
        u = r + t
        J = []
        for channel in (0, 2):
            e = np.zeros(3)
            e[channel] = 1
            # d(a / |a|) / d ln k_c = u_c e - u u_c^2
            J.append((u[:, channel, None] * e - u * u[:, channel, None] ** 2).ravel())
        step = np.linalg.lstsq(np.array(J).T, -r.ravel(), rcond=None)[0]
        while (residual(x + step) ** 2).sum() > (r**2).sum() and np.abs(step).max() > 1e-12:
            step = step / 2
        x = x + step
    return np.exp([x[0], 0, x[1]])
