"""Homework 5 in loops."""

# %%
import math

import numpy as np
from scipy import stats

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
                E[i, k] = sum(
                    w * X[j, i, k] / t[j] for w, j in zip(weights, seen, strict=True)
                ) / sum(weights)
                light = [E[i, k] * t[j] for j in seen]
            s[i, k] = sum(weights) ** -0.5
    return E, s


# %% task="guided"


def fit(I, p, y, x, radius, epsilon):
    square = np.s_[max(0, y - radius) : y + radius + 1, max(0, x - radius) : x + radius + 1]
    i, wanted = I[square].ravel(), p[square].ravel()
    a = np.mean((i - i.mean()) * (wanted - wanted.mean())) / (i.var() + epsilon)
    return a, wanted.mean() - a * i.mean()


def guided(I, p=None, *, radius, epsilon):
    p = I if p is None else p
    H, W = I.shape
    found = np.array([[fit(I, p, y, x, radius, epsilon) for x in range(W)] for y in range(H)])
    q = np.zeros((H, W))
    for y in range(H):
        for x in range(W):
            holders = found[
                max(0, y - radius) : y + radius + 1, max(0, x - radius) : x + radius + 1
            ]
            a, b = holders.mean(axis=(0, 1))
            q[y, x] = a * I[y, x] + b
    return q


# %% task="remap"


def remap(lL, g, *, sigma, alpha, beta):
    r = np.zeros(lL.shape)
    for (y, x), value in np.ndenumerate(lL):
        d = abs(float(value) - g)
        far = sigma * (d / sigma) ** alpha if d <= sigma else sigma + beta * (d - sigma)
        if alpha < 1 and d < 0.02:
            step = max(d / 0.01 - 1, 0)
            tau = (step * (2 - step)) ** 2
            far = tau * far + (1 - tau) * d
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


# %% task="gain_map"


def gain_map(sdr, hdr, low, high, *, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    low, high = (np.broadcast_to(one, np.shape(sdr)) for one in (low, high))
    g = np.zeros(np.shape(sdr))
    for place in np.ndindex(g.shape):
        gain = math.log2((float(hdr[place]) + k[1]) / (float(sdr[place]) + k[0]))
        part = (gain - low[place]) / (high[place] - low[place])
        g[place] = min(max(part, 0.0), 1.0) ** gamma
    return g


# %% task="apply_gain"


def apply_gain(sdr, g, low, high, *, W=1.0, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    low, high, gamma = (np.broadcast_to(one, np.shape(sdr)) for one in (low, high, gamma))
    light = np.zeros(np.shape(sdr))
    for place in np.ndindex(light.shape):
        gain = low[place] + (high[place] - low[place]) * float(g[place]) ** (1 / gamma[place])
        light[place] = (float(sdr[place]) + k[0]) * 2.0 ** (W * gain) - k[1]
    return light


# %% task="line"


def line(S, V):
    above = below = 0.0
    for s, v in zip(S, V, strict=True):
        weight = 1.0 / float(v) ** 2
        above += weight * float(s) * (float(v) - float(V[0]))
        below += weight * float(s) ** 2
    return above / below


# %% task="brightness_transfer"


def brightness_transfer(h_A, h_B):
    n = len(h_A)
    total_a, total_b = float(sum(h_A)), float(sum(h_B))
    T, below = np.full(n, np.nan), 0.0
    for m in range(n):
        rank = (below + h_A[m] / 2) / total_a
        below += h_A[m]
        lower = 0.0
        for z in range(n):
            upper = lower + h_B[z] / total_b
            if lower <= rank <= upper and upper > lower:
                if 0 < z < n - 1:
                    T[m] = z - 0.5 + (rank - lower) / (upper - lower)
                break
            lower = upper
    return T


# %% task="snr"


def snr(g, *, least=0.01, span=4):
    n = len(g)
    f = [math.exp(float(one)) for one in g]
    mean = (f[-1] - f[0]) / (n - 1)
    w = []
    for z in range(n):
        a, b = max(0, z - span), min(n - 1, z + span)
        slope = (f[b] - f[a]) / (b - a)
        w.append(f[z] / max(slope, least * mean))
    w[0] = w[-1] = 0.0
    return w


# %% task="weight"


def weight(F, powers=(1, 1, 1)):
    _, H, W = F.shape
    Y = 0.299 * F[0] + 0.587 * F[1] + 0.114 * F[2]
    out = np.zeros((H, W))
    for y in range(H):
        for x in range(W):
            r, g, b = (float(one) for one in F[:, y, x])
            near = (
                Y[max(y - 1, 0), x]
                + Y[min(y + 1, H - 1), x]
                + Y[y, max(x - 1, 0)]
                + Y[y, min(x + 1, W - 1)]
            )
            mean = (r + g + b) / 3
            C = abs(near - 4 * Y[y, x])
            S = math.sqrt(((r - mean) ** 2 + (g - mean) ** 2 + (b - mean) ** 2) / 3)
            E = math.prod(math.exp(-((v - 0.5) ** 2) / (2 * 0.2**2)) for v in (r, g, b))
            out[y, x] = C ** powers[0] * S ** powers[1] * E ** powers[2]
    return out


# %% task="optimum"


def optimum(EV_pre, B_pre, B_opt=0.18):
    return np.array([EV_pre + np.log(B_pre / B_opt) / np.log(2)])


# %% task="spot"


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    H, W = shape
    place = at[0] * H, at[1] * W
    near = sorted((math.dist((y + 0.5, x + 0.5), place), y, x) for y in range(H) for x in range(W))
    count = max(1, round(share * H * W))
    w = np.zeros((H, W))
    for _, y, x in near[:count]:
        w[y, x] = 1 / count
    return w


# %% task="centre"


def centre(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    H, W = shape
    places = []
    for i in range(H):
        for j in range(W):
            v, u = (i + 0.5) / H - at[0], (j + 0.5) / W - at[1]
            places.append((math.hypot(v * H, u * W), v * v + u * u, i, j))
    places.sort()
    count = max(1, round(share * H * W))

    def part(precision):
        each = [math.exp(-precision * d2) for _, d2, _, _ in places]
        return sum(each[:count]) / sum(each)

    low, high = 1e-6, 1e4
    for _ in range(60):
        middle = math.sqrt(low * high)
        if part(middle) < inside:
            low = middle
        else:
            high = middle
    w = np.zeros((H, W))
    for _, d2, i, j in places:
        w[i, j] = math.exp(-low * d2)
    return w / w.sum()


# %% task="flat"


def flat(A, *, size=5, psi=0.05, sigma=0.01):
    t, H, W = A.shape
    s, r = size**2, size // 2
    found = np.zeros((H, W))
    limit = stats.chi2.isf(psi, s - 1) if t == 1 else (s - 1) * stats.f.isf(psi, s - 1, s * (t - 1))
    for y in range(r, H - r):
        for x in range(r, W - r):
            patch = A[:, y - r : y + r + 1, x - r : x + r + 1]
            noise = sigma**2 if t == 1 else np.mean(np.var(patch, axis=0, ddof=1))
            average = patch.sum(axis=0) / t
            found[y, x] = s * np.var(average) <= limit * noise / t
    return found


# %% task="solve_by_svd"


def solve_by_svd(A, b, *, rtol=1e-10):
    U, s, Vt = np.linalg.svd(A)
    x = np.zeros(A.shape[1])
    for i in range(len(s)):
        if s[i] > rtol * s[0]:
            x += U[:, i] @ b / s[i] * Vt[i]
    return x


# %% task="balance_white"


def balance_white(X, c, gains):
    smallest = min(float(gain) for gain in gains)
    balanced = np.zeros(np.shape(X))
    for place in np.ndindex(balanced.shape):
        balanced[place] = min(float(X[place]) * float(gains[c[place]]) / smallest, 1.0)
    return balanced


# %% task="screen_from_camera"


def screen_from_camera(M, P):
    A = [[sum(M[i][j] * P[j][k] for j in range(3)) for k in range(3)] for i in range(3)]
    return np.linalg.inv([[value / sum(row) for value in row] for row in A])
