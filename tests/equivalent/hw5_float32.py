"""Homework 5 in float32, mirrored at the edges."""

# %%
import numpy as np
from scipy.ndimage import convolve1d

f32 = np.float32

# %% task="variance"


def variance(X, D, N, R):
    X, D = np.float32(X), np.float32(D)
    return X / np.float32(N) + np.float32(R / N) ** 2 + D**2 / np.float32(12)


# %% task="inverse_variance_merge"


def inverse_variance_merge(X, D, measured, t, N, R):
    t = np.float32(t)[:, None, None]
    light = np.float32(X)
    for _ in range(3):
        V = np.where(measured, variance(light, D, N, R) / t**2, np.float32(np.inf))
        E = np.sum(np.float32(X) / t / V, axis=0) / np.sum(1 / V, axis=0)
        light = E * t
    return E, 1 / np.sqrt(np.sum(1 / V, axis=0))


# %% task="guided"


def guided(I, p=None, *, radius, epsilon):
    I = I.astype(f32)
    p = I if p is None else p.astype(f32)
    kernel = np.full(2 * radius + 1, 1 / (2 * radius + 1), f32)

    def mean(x):
        return convolve1d(convolve1d(x, kernel, axis=0), kernel, axis=1)

    a = (mean(I * p) - mean(I) * mean(p)) / (mean(I * I) - mean(I) ** 2 + f32(epsilon))
    return mean(a) * I + mean(mean(p) - a * mean(I))


# %% task="remap"


def remap(lL, g, *, sigma, alpha, beta):
    d = lL.astype(f32) - f32(g)
    edge = np.abs(d) > sigma
    near = f32(sigma) * (np.abs(d) / f32(sigma)) ** f32(alpha)
    far = f32(sigma) + f32(beta) * (np.abs(d) - f32(sigma))
    return f32(g) + np.where(d > 0, 1, -1).astype(f32) * np.where(edge, far, near)


# %% task="pq"


def pq(FD):
    Y = (np.asarray(FD, f32) / f32(10_000)) ** f32(2610 / 16384)
    quotient = (f32(0.8359375) + f32(18.8515625) * Y) / (f32(1) + f32(18.6875) * Y)
    return quotient ** f32(78.84375)
