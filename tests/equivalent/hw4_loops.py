"""Homework 4 in loops."""

# %%
import math

import numpy as np

# %% task="log_average"


def log_average(L, *, delta=1e-6):
    total = 0.0
    seen = sorted(value for value in np.ravel(L).tolist() if value > 0)
    middle = (seen[len(seen) // 2] + seen[(len(seen) - 1) // 2]) / 2 if seen else 1.0
    for value in np.ravel(L).tolist():
        total += math.log(delta * middle + value)
    return math.exp(total / L.size)


# %% task="display"


def display(Lm, adaptation, white=float("inf")):
    Ld = np.zeros(Lm.shape)
    for (y, x), value in np.ndenumerate(Lm):
        scaled = float(value) * (1 + float(value) / white**2) / (1 + float(adaptation[y, x]))
        Ld[y, x] = min(scaled, 1.0)
    return Ld


# %% task="scale_steps"


def scale_steps(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    H, W = blurred[0].shape
    still, chosen = np.ones((H, W), bool), np.array(blurred[0])
    s = 1.0
    for k in range(len(blurred) - 1):
        V = np.zeros((H, W))
        for y in range(H):
            for x in range(W):
                V1, V2 = float(blurred[k][y, x]), float(blurred[k + 1][y, x])
                V[y, x] = (V1 - V2) / (2**phi * key / s**2 + V1)
                if abs(V[y, x]) >= threshold:
                    still[y, x] = False
                if still[y, x]:
                    chosen[y, x] = V1
        yield s, blurred[k], V, still.copy(), chosen.copy()
        s *= 1.6


# %% task="layers"


def layers(lL, *, sigma_s, sigma_r=0.4):
    H, W = lL.shape
    r = round(3 * sigma_s)
    base = np.zeros((H, W))
    for y in range(H):
        for x in range(W):
            top, left = max(0, y - r), max(0, x - r)
            q = lL[top : y + r + 1, left : x + r + 1].astype(float)
            i, j = np.ogrid[top - y : top - y + q.shape[0], left - x : left - x + q.shape[1]]
            weight = np.exp(
                -(i**2 + j**2) / (2 * sigma_s**2) - (q - lL[y, x]) ** 2 / (2 * sigma_r**2)
            )
            base[y, x] = (weight * q).sum() / weight.sum()
    return base, lL - base


# %% task="compress"


def compress(base, low, high, *, contrast=50.0):
    c = math.log(contrast, 10)
    m = c / (high - low) if high - low > c else 1
    return np.array([[m * (float(b) - high) for b in row] for row in base])


# %% task="adjust_steps"


def adjust_steps(f, db, D, *, tolerance=0.025):
    f = [float(count) for count in f]
    least = tolerance * sum(f)
    yield np.array(f), math.inf, sum(f), math.inf
    while sum(f) > least:
        T = sum(f)
        ceiling, trimmings = T * db / D, 0.0
        for i in range(len(f)):
            if f[i] > ceiling:
                trimmings += f[i] - ceiling
                f[i] = ceiling
        yield np.array(f), ceiling, T, trimmings
        if trimmings < tolerance * T:
            return


# %% task="scale"


def scale(L, *, headroom=8.0, sigma=None):
    sigma = 0.08 * max(L.shape) if sigma is None else sigma
    r = int(4 * sigma)
    taps = [math.exp(-(d**2) / (2 * sigma**2)) for d in range(-r, r + 1)]
    taps = [tap / sum(taps) for tap in taps]
    for _ in range(2):  # along one axis, and then along the other
        wide = np.pad(np.asarray(L, float), ((r, r), (0, 0)), mode="edge")
        L = sum(tap * wide[d : d + len(wide) - 2 * r] for d, tap in enumerate(taps)).T
    return 1 / (headroom * L)


# %% task="attenuation_steps"


def smaller(H):
    wide = np.pad(H, 1, mode="edge")
    for axis in (0, 1):
        n = wide.shape[axis]
        take = [np.take(wide, range(i, n - 2 + i), axis=axis) for i in range(3)]
        wide = (take[0] + 2 * take[1] + take[2]) / 4
    return wide[::2, ::2]


def larger(Phi, shape):
    for axis in (0, 1):
        n, m = shape[axis], Phi.shape[axis]
        at = np.minimum(np.arange(n) / 2, m - 1)
        i = np.minimum(at.astype(int), m - 2)
        part = np.reshape(at - i, (-1, 1) if axis == 0 else (1, -1))
        Phi = np.take(Phi, i, axis=axis) * (1 - part) + np.take(Phi, i + 1, axis=axis) * part
    return Phi


def attenuation_steps(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    pyramid = [np.asarray(lL, float)]
    while min((n + 1) // 2 for n in pyramid[-1].shape) >= 32:
        pyramid.append(smaller(pyramid[-1]))
    Phi = None
    for k in range(len(pyramid) - 1, -1, -1):
        dy, dx = np.gradient(pyramid[k])
        slope = np.hypot(dy, dx) / 2**k
        a = alpha * slope.mean()
        phi = (np.maximum(slope, noise * slope.mean()) / a) ** (beta - 1)
        Phi = phi if Phi is None else larger(Phi, phi.shape) * phi
        yield k, pyramid[k], slope, phi, Phi


# %% task="divergence"


def divergence(G):
    f = np.zeros(G.shape[1:])
    H, W = f.shape
    for y in range(H):
        for x in range(W):
            f[y, x] = (G[0, y, x] if y < H - 1 else 0) - (G[0, y - 1, x] if y > 0 else 0)
            f[y, x] += (G[1, y, x] if x < W - 1 else 0) - (G[1, y, x - 1] if x > 0 else 0)
    return f


# %% task="solve"


def solve(f):
    """Solve the whole system of equations, a row a pixel, with one pixel held at 0."""
    H, W = f.shape
    A = np.zeros((H * W, H * W))
    for y in range(H):
        for x in range(W):
            for i, j in ((y - 1, x), (y + 1, x), (y, x - 1), (y, x + 1)):
                if 0 <= i < H and 0 <= j < W:
                    A[y * W + x, i * W + j] += 1
                    A[y * W + x, y * W + x] -= 1
    A[0] = 0
    A[0, 0] = 1
    b = np.array(f, float).ravel()
    b[0] = 0
    return np.linalg.solve(A, b).reshape(H, W)


# %% task="fix_uncertain"


def fix_uncertain(mean, k, *, sigma_s):
    H, W = mean.shape
    reach = 6
    bell = [math.exp(-d * d / 8) for d in range(-reach, reach + 1)]
    weight = np.outer(bell, bell)
    padded = np.pad(mean.astype(float), reach, mode="symmetric")
    base = mean.astype(float).copy()
    limit = math.log(math.sqrt(2 * math.pi * sigma_s**2))
    for y in range(H):
        for x in range(W):
            u = min(max(math.log(k[y, x]) / limit, 0.0), 1.0)
            if u < 1:
                around = padded[y : y + 2 * reach + 1, x : x + 2 * reach + 1]
                base[y, x] = u * mean[y, x] + (1 - u) * (weight * around).sum() / weight.sum()
    return base
