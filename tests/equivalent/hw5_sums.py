"""Homework 5 with summed-area tables, clipping and logarithms."""

# %%
import numpy as np
from scipy import linalg, stats

# %% task="variance"


def variance(X, D, N, R):
    return (X * N + R**2 + (D * N) ** 2 / 12) / N**2


# %% task="inverse_variance_merge"


def inverse_variance_merge(X, D, measured, t, N, R):
    t = np.reshape(t, (-1, 1, 1))
    w = np.where(measured, t**2 / variance(X, D, N, R), 0)
    for _ in range(8):
        E = (w * X / t).sum(axis=0) / w.sum(axis=0)
        w = np.where(measured, t**2 / variance(E * t, D, N, R), 0)
    return E, w.sum(axis=0) ** -0.5


# %% task="guided"


def mean(x, radius):
    """The mean over each window, from a summed-area table; beyond the edge its last pixels go on."""
    n = 2 * radius + 1
    table = np.pad(x, ((radius + 1, radius), (radius + 1, radius)), mode="edge").cumsum(0).cumsum(1)
    table -= table[:1]
    table -= table[:, :1]
    total = table[n:, n:] - table[:-n, n:] - table[n:, :-n] + table[:-n, :-n]
    return total / n**2


def guided(I, p=None, *, radius, epsilon):
    p = I if p is None else p
    centred, wanted = I - I.mean(), p - p.mean()
    a = mean(centred * wanted, radius) - mean(centred, radius) * mean(wanted, radius)
    a = a / (mean(centred**2, radius) - mean(centred, radius) ** 2 + epsilon)
    b = mean(wanted, radius) - a * mean(centred, radius)
    return mean(a, radius) * centred + mean(b, radius) + p.mean()


# %% task="remap"


def remap(lL, g, *, sigma, alpha, beta):
    d = lL - g
    detail = np.clip(d, -sigma, sigma)
    raised = np.sign(detail) * np.abs(detail / sigma) ** alpha * sigma
    if alpha < 1:
        y = np.clip(100 * np.abs(d) - 1, 0, 1)
        tau = y**2 * (2 - y) ** 2
        raised = tau * raised + (1 - tau) * detail
    return g + raised + beta * (d - detail)


# %% task="pq"


def pq(FD):
    with np.errstate(divide="ignore"):
        Y = np.exp(2610 / 16384 * (np.log(FD) - np.log(1e4)))
    top, bottom = 3424 + 32 * 2413 * Y, 4096 + 32 * 2392 * Y
    return np.exp(128 * 2523 / 4096 * (np.log(top) - np.log(bottom)))


# %% task="gain_map"


def gain_map(sdr, hdr, low, high, *, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    with np.errstate(divide="ignore"):
        stops = (np.log(hdr + k[1]) - np.log(sdr + k[0])) / np.log(2)
    return (np.clip(stops, low, high) - low) ** gamma / (np.asarray(high) - low) ** gamma


# %% task="apply_gain"


def apply_gain(sdr, g, low, high, *, W=1.0, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    part = np.power(g, 1 / np.asarray(gamma, float))
    full = 2.0 ** np.asarray(low) * (2.0 ** (np.asarray(high) - low)) ** part
    return (sdr + k[0]) * full**W - k[1]


# %% task="line"


def line(S, V):
    S, V = np.asarray(S, float), np.asarray(V, float)
    slope, *_ = np.linalg.lstsq((S / V)[:, None], (V - V[0]) / V, rcond=None)
    return slope[0]


# %% task="brightness_transfer"


def brightness_transfer(h_A, h_B):
    a, b = np.asarray(h_A) / np.sum(h_A), np.asarray(h_B) / np.sum(h_B)
    rank, top = np.cumsum(a) - a / 2, np.cumsum(b)
    z = np.clip(np.searchsorted(top, rank), 0, len(b) - 1)
    T = z - 0.5 + (rank - (top[z] - b[z])) / b[z]
    T[(z == 0) | (z == len(b) - 1)] = np.nan
    return T


# %% task="snr"


def snr(g, *, least=0.01, span=4):
    f = np.exp(np.asarray(g, float))
    z = np.arange(f.size)
    low, high = (z - span).clip(0), (z + span).clip(max=f.size - 1)
    slope = (f[high] - f[low]) / (high - low)
    w = f / np.maximum(slope, least * (f[-1] - f[0]) / (f.size - 1))
    w[0] = w[-1] = 0
    return w / w.max()


# %% task="weight"


def weight(F, powers=(1, 1, 1)):
    image = np.moveaxis(F, 0, -1).astype(np.float64)
    Y = image @ [0.299, 0.587, 0.114]
    C = abs(sum(np.roll(Y, step, axis) for step in (1, -1) for axis in (0, 1)) - 4 * Y)
    S = np.sqrt(np.mean((image - image.mean(-1, keepdims=True)) ** 2, -1))
    E = np.ones_like(Y)
    for channel in range(3):
        E *= np.exp(-((image[..., channel] - 0.5) ** 2) / (2 * 0.2**2))
    measures = np.stack([C, S, E])
    return np.prod(measures ** np.reshape(powers, (3, 1, 1)), axis=0)


# %% task="optimum"


def optimum(EV_pre, B_pre, B_opt=0.18):
    return EV_pre + np.log2(B_pre) - np.log2(B_opt)


# %% task="spot"


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    y, x = np.indices(shape) + 0.5
    d = (y - at[0] * shape[0]) ** 2 + (x - at[1] * shape[1]) ** 2
    k = max(int(np.rint(share * d.size)), 1)
    w = np.zeros(d.size)
    w[np.argsort(d, axis=None, kind="stable")[:k]] = 1.0
    return (w / w.sum()).reshape(shape)


# %% task="centre"


def centre(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    H, W = shape
    y, x = np.mgrid[0:H, 0:W]
    dy, dx = (y + 0.5) / H - at[0], (x + 0.5) / W - at[1]
    order = np.lexsort((np.hypot(dy * H, dx * W).ravel(),))
    core = np.zeros(H * W, bool)
    core[order[: max(1, round(share * H * W))]] = True
    d2 = (dy**2 + dx**2).ravel()
    a, b = np.log(0.005), np.log(200)
    for _ in range(80):
        m = 0.5 * (a + b)
        e = -d2 / (2 * np.exp(2 * m))
        w = np.exp(e - e.max())
        a, b = (m, b) if w[core].sum() / w.sum() > inside else (a, m)
    return (w / w.sum()).reshape(H, W)


# %% task="flat"


def flat(A, *, size=5, psi=0.05, sigma=0.01):
    t, H, W = A.shape
    r, s = size // 2, size**2
    average = A.mean(axis=0)
    offsets = [(dy, dx) for dy in range(-r, r + 1) for dx in range(-r, r + 1)]
    moved = np.array([np.roll(average, one, axis=(0, 1)) for one in offsets])
    spread = ((moved - moved.mean(axis=0)) ** 2).mean(axis=0)
    if t > 1:
        single = A.var(axis=0, ddof=1)
        noise = sum(np.roll(single, one, axis=(0, 1)) for one in offsets) / s
        top = (s - 1) * stats.f.isf(psi, s - 1, s * (t - 1))
    else:
        noise, top = sigma**2, stats.chi2.isf(psi, s - 1)
    y, x = np.indices((H, W))
    inside = (y >= r) & (y < H - r) & (x >= r) & (x < W - r)
    return inside & (s * spread / (noise / t) <= top)


# %% task="solve_by_svd"


def solve_by_svd(A, b, rtol=1e-10):
    U, s, Vh = linalg.svd(A, full_matrices=False)
    large = s > rtol * s.max()
    inverse = np.where(large, 1 / np.where(large, s, 1), 0)
    return Vh.T @ np.diag(inverse) @ U.T @ b[:, None]


# %% task="balance_white"


def balance_white(X, c, gains):
    g = np.asarray(gains) / min(gains)
    factor = sum(g[k] * (np.asarray(c) == k) for k in range(3))
    return np.where(X * factor > 1, 1.0, X * factor)


# %% task="screen_from_camera"


def screen_from_camera(M, P):
    A = np.einsum("ij,jk->ik", M, P)
    white = A @ np.ones(3)
    return np.linalg.inv(A) @ np.diag(white)
