"""Homework 5 in float32, with mirrored borders."""

# %%
import numpy as np
from scipy.ndimage import convolve1d
from scipy.optimize import minimize_scalar
from scipy.stats import chi2, f, rankdata

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
    if alpha < 1:
        y = np.clip(np.abs(d) / f32(0.01) - f32(1), f32(0), f32(1))
        near += (f32(1) - y**2 * (f32(2) - y) ** 2) * (np.abs(d) - near)
    far = f32(sigma) + f32(beta) * (np.abs(d) - f32(sigma))
    return f32(g) + np.where(d > 0, 1, -1).astype(f32) * np.where(edge, far, near)


# %% task="pq"


def pq(FD):
    Y = (np.asarray(FD, f32) / f32(10_000)) ** f32(2610 / 16384)
    quotient = (f32(0.8359375) + f32(18.8515625) * Y) / (f32(1) + f32(18.6875) * Y)
    return quotient ** f32(78.84375)


# %% task="gain_map"


def gain_map(sdr, hdr, low, high, *, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    below, above = (
        np.asarray(one, f32) + f32(offset) for one, offset in zip((sdr, hdr), k, strict=True)
    )
    low, high = np.asarray(low, f32), np.asarray(high, f32)
    part = (np.log2(above / below) - low) / (high - low)
    return np.minimum(np.maximum(part, f32(0)), f32(1)) ** f32(gamma)


# %% task="apply_gain"


def apply_gain(sdr, g, low, high, *, W=1.0, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    low, high, gamma = np.asarray(low, f32), np.asarray(high, f32), np.asarray(gamma, f32)
    gain = low + (high - low) * np.asarray(g, f32) ** (f32(1) / gamma)
    return (np.asarray(sdr, f32) + f32(k[0])) * np.exp2(f32(W) * gain) - f32(k[1])


# %% task="line"


def line(S, V):
    s, v = np.float32(S)[1:], np.float32(V)
    x, y = s / v[1:], (v[1:] - v[0]) / v[1:]
    return np.array([x @ y / (x @ x)])


# %% task="brightness_transfer"


def brightness_transfer(h_A, h_B):
    n = np.size(h_B)

    def cumulate(h):
        return np.insert(np.cumsum(h), 0, 0) / np.sum(h)

    middle = np.convolve(cumulate(h_A), [0.5, 0.5], "valid")
    T = (np.interp(middle, cumulate(h_B), np.arange(n + 1)) - 0.5).astype(np.float32)
    return np.where((T < 0.5) | (T > n - 1.5), np.float32(np.nan), T)


# %% task="snr"


def snr(g, *, least=0.01, span=4):
    g = np.asarray(g, np.float32)
    f = np.exp(g - g[len(g) // 2])
    n = len(f)
    index = np.arange(n)
    a, b = np.maximum(index - span, 0), np.minimum(index + span, n - 1)
    d = (f[b] - f[a]) / (b - a).astype(np.float32) * np.float32(n - 1) / (f[-1] - f[0])
    d[d < least] = least
    w = f / d
    w[[0, n - 1]] = 0
    return w


# %% task="weight"


def weight(F, powers=(1, 1, 1)):
    F = np.asarray(F, np.float32)
    Y = np.float32(0.299) * F[0] + np.float32(0.587) * F[1] + np.float32(0.114) * F[2]
    L = np.zeros_like(Y)
    L[1:] += Y[:-1] - Y[1:]
    L[:-1] += Y[1:] - Y[:-1]
    L[:, 1:] += Y[:, :-1] - Y[:, 1:]
    L[:, :-1] += Y[:, 1:] - Y[:, :-1]
    C, S = np.abs(L), np.std(F, axis=0, ddof=0)
    E = np.exp(-12.5 * ((F - np.float32(0.5)) ** 2).sum(axis=0))
    return (C ** powers[0] * S ** powers[1] * E ** powers[2]).tolist()


# %% task="optimum"


def optimum(EV_pre, B_pre, B_opt=0.18):
    return np.float32(EV_pre) + np.log2(np.float32(B_pre) / np.float32(B_opt))


# %% task="spot"


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    z = (np.arange(shape[0])[:, None] - at[0] * shape[0] + 0.5) + 1j * (
        np.arange(shape[1]) - at[1] * shape[1] + 0.5
    )
    ranks = rankdata(np.abs(z), method="ordinal").reshape(shape)
    k = max(1, round(share * z.size))
    return ((ranks <= k) / np.float32(k)).astype(np.float32).tolist()


# %% task="centre"


def centre(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    y, x = (np.indices(shape).reshape(2, -1).T + 0.5).T
    d2 = (y / shape[0] - at[0]) ** 2 + (x / shape[1] - at[1]) ** 2
    pixels = (y - at[0] * shape[0]) ** 2 + (x - at[1] * shape[1]) ** 2
    rank = np.argsort(np.argsort(pixels))
    core = rank < round(share * pixels.size)

    def off(log_sigma):
        w = np.exp(-d2 / (2 * np.exp(2 * log_sigma)))
        return (w[core].sum() / w.sum() - inside) ** 2

    best = minimize_scalar(
        off, bounds=(np.log(0.05), np.log(3)), method="bounded", options={"xatol": 1e-8}
    )
    w = np.exp(-d2 / (2 * np.exp(2 * best.x)))
    return (w / w.sum()).reshape(shape).astype(np.float32)


# %% task="flat"


def boxes(a, n):
    S = np.pad(a, ((1, 0), (1, 0))).cumsum(0).cumsum(1)
    return S[n:, n:] - S[:-n, n:] - S[n:, :-n] + S[:-n, :-n]


def flat(A, *, size=5, psi=0.05, sigma=0.01):
    t, s, r = len(A), size**2, size // 2
    mean = A.mean(axis=0)
    a = mean - mean.mean()
    squares = boxes(a * a, size) - boxes(a, size) ** 2 / s
    mask = np.zeros(mean.shape, np.uint8)
    if t == 1:
        good = squares <= sigma**2 * chi2.isf(psi, s - 1)
    else:
        one = boxes(A.var(axis=0, ddof=1), size) / s
        good = squares * t <= one * (s - 1) * f.isf(psi, s - 1, s * (t - 1))
    mask[r : r + good.shape[0], r : r + good.shape[1]] = good
    return mask


# %% task="solve_by_svd"


def solve_by_svd(A, b, *, rtol=1e-10):
    Q, R = np.linalg.qr(A)
    U, s, Vt = np.linalg.svd(R)
    c = U.T @ (Q.T @ b)
    return sum(
        (c[i] / s[i] * Vt[i] for i in range(len(s)) if s[i] > rtol * s[0]), np.zeros(A.shape[1])
    ).tolist()


# %% task="balance_white"


def balance_white(X, c, gains):
    g = np.asarray(gains, f32) / f32(np.min(gains))
    return np.minimum(np.asarray(X, f32) * np.take(g, c), f32(1))


# %% task="screen_from_camera"


def screen_from_camera(M, P):
    A = np.dot(M, P)
    return np.linalg.solve(A / A.sum(1)[:, None], np.eye(3))
