"""Homework 5 in loops."""

# %%
import math

import numpy as np

# %% task="variance"


def variance(X, D, N, R):
    V = []
    for row, steps in zip(np.atleast_2d(X), np.atleast_2d(D), strict=True):
        V.append([x / N + R * R / (N * N) + d * d / 12 for x, d in zip(row, steps, strict=True)])
    return V


# %% task="inverse_variance_merge"


def inverse_variance_merge(X, D, measured, t, N, R):
    E, s = np.zeros(X.shape[1:]), np.zeros(X.shape[1:])
    for i in range(X.shape[1]):
        for k in range(X.shape[2]):
            seen = [j for j in range(len(t)) if measured[j, i, k]]
            light = [X[j, i, k] for j in seen]
            for _ in range(3):
                weights = [
                    t[j] ** 2 / (x / N + (R / N) ** 2 + D[j, i, k] ** 2 / 12)
                    for j, x in zip(seen, light, strict=True)
                ]
                E[i, k] = sum(w * X[j, i, k] / t[j] for w, j in zip(weights, seen, strict=True)) / sum(
                    weights
                )
                light = [E[i, k] * t[j] for j in seen]
            s[i, k] = sum(weights) ** -0.5
    return E, s


# %% task="guided"


def line(I, p, y, x, radius, epsilon):
    square = np.s_[max(0, y - radius) : y + radius + 1, max(0, x - radius) : x + radius + 1]
    i, wanted = I[square].ravel(), p[square].ravel()
    a = np.mean((i - i.mean()) * (wanted - wanted.mean())) / (i.var() + epsilon)
    return a, wanted.mean() - a * i.mean()


def guided(I, p=None, *, radius, epsilon):
    p = I if p is None else p
    H, W = I.shape
    found = np.array([[line(I, p, y, x, radius, epsilon) for x in range(W)] for y in range(H)])
    q = np.zeros((H, W))
    for y in range(H):
        for x in range(W):
            holders = found[max(0, y - radius) : y + radius + 1, max(0, x - radius) : x + radius + 1]
            a, b = holders.mean(axis=(0, 1))
            q[y, x] = a * I[y, x] + b
    return q


# %% task="remap"


def remap(lL, g, *, sigma, alpha, beta):
    r = np.zeros(lL.shape)
    for (y, x), value in np.ndenumerate(lL):
        d = abs(float(value) - g)
        far = sigma * (d / sigma) ** alpha if d <= sigma else sigma + beta * (d - sigma)
        r[y, x] = g + math.copysign(far, value - g)
    return r


# %% task="pq"


def pq(FD):
    m1, m2 = 2610 / 16384, 128 * 2523 / 4096
    c1, c2, c3 = 3424 / 4096, 32 * 2413 / 4096, 32 * 2392 / 4096
    v = np.zeros(np.shape(FD))
    for place, value in np.ndenumerate(FD):
        power = (float(value) / 10_000) ** m1
        v[place] = ((c1 + c2 * power) / (1 + c3 * power)) ** m2
    return v
