"""Homework 4 in float32."""

# %%
import numpy as np
from scipy.fft import dctn, idctn
from scipy.ndimage import gaussian_filter, gaussian_filter1d, zoom

f32 = np.float32

# %% task="log_average"


def log_average(L, *, delta=1e-6):
    L = L.astype(f32)
    black = f32(delta) * (np.median(L[L > 0]) if L.any() else f32(1))
    return np.exp(np.mean(np.log(L + black), dtype=f32))


# %% task="display"


def display(Lm, adaptation, white=np.inf):
    Lm = Lm.astype(f32)
    return np.clip(Lm * (1 + Lm / f32(white) ** 2) / (1 + adaptation.astype(f32)), 0, 1)


# %% task="scale_steps"


def scale_steps(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    V1 = np.array(blurred, f32)
    s = f32(1.6) ** np.arange(len(V1) - 1, dtype=f32)
    V = (V1[:-1] - V1[1:]) / (f32(2**phi * key) / s[:, None, None] ** 2 + V1[:-1])
    even = np.logical_and.accumulate(np.abs(V) < f32(threshold))
    for k in range(len(V)):
        last = np.maximum(even[: k + 1].sum(axis=0) - 1, 0)
        yield s[k], V1[k], V[k], even[k], np.take_along_axis(V1, last[None], axis=0)[0]


# %% task="layers"


def layers(lL, *, sigma_s, sigma_r=0.4):
    """Blur slices of the range, and read each pixel between the two slices around its level."""
    lL = lL.astype(f32)
    levels = np.arange(lL.min(), lL.max() + 0.1, sigma_r / 8, dtype=f32)
    slices = []
    for level in levels:
        w = np.exp(-((lL - level) ** 2) / f32(2 * sigma_r**2))
        blur = [gaussian_filter(one, sigma_s, mode="constant", truncate=3.0) for one in (w * lL, w)]
        slices.append(blur[0] / np.maximum(blur[1], f32(1e-20)))
    at = (lL - levels[0]) / (levels[1] - levels[0])
    i = np.minimum(at.astype(int), len(levels) - 2)
    low, high = (np.take_along_axis(np.stack(slices), k[None], axis=0)[0] for k in (i, i + 1))
    base = low + (at - i).astype(f32) * (high - low)
    return base, lL - base


# %% task="compress"


def compress(base, low, high, *, contrast=50.0):
    m = min(f32(1), np.log10(f32(contrast)) / f32(high - low))
    return m * base.astype(f32) - m * f32(high)


# %% task="adjust_steps"


def adjust_steps(f, db, D, *, tolerance=0.025):
    f = f.astype(f32)
    T = f.sum()
    least = tolerance * T
    trimmings = f32(np.inf)
    yield f, f32(np.inf), T, trimmings
    while trimmings >= tolerance * T and f.sum() > least:
        T = f.sum()
        ceiling = T * f32(db / D)
        trimmings = np.clip(f - ceiling, 0, None).sum()
        f = np.clip(f, None, ceiling)
        yield f, ceiling, T, trimmings


# %% task="scale"


def scale(L, *, headroom=8.0, sigma=None):
    blurred = gaussian_filter(L.astype(f32), sigma or 0.08 * max(L.shape), mode="nearest")
    return f32(1) / (f32(headroom) * blurred)


# %% task="attenuation_steps"


def attenuation_steps(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    pyramid = [lL.astype(f32)]
    while min(pyramid[-1].shape) >= 63:
        pyramid.append(gaussian_filter(pyramid[-1], 0.8, mode="reflect")[::2, ::2])
    Phi = np.ones((1, 1), f32)
    for k, level in reversed(list(enumerate(pyramid))):
        dy, dx = np.gradient(level)
        slope = np.sqrt(dy**2 + dx**2) / f32(2**k)
        phi = (np.maximum(slope, f32(noise) * slope.mean()) / (f32(alpha) * slope.mean())) ** f32(
            beta - 1
        )
        H, W = phi.shape
        larger = zoom(
            Phi, (H / Phi.shape[0], W / Phi.shape[1]), order=1, mode="nearest", grid_mode=True
        )
        Phi = larger * phi
        yield k, level, slope, phi, Phi


# %% task="divergence"


def divergence(G):
    Gy, Gx = G.astype(f32)
    Gy[-1] = 0
    Gx[:, -1] = 0
    return np.diff(Gy, axis=0, prepend=f32(0)) + np.diff(Gx, axis=1, prepend=f32(0))


# %% task="solve"


def solve(f):
    f = f.astype(f32)
    H, W = f.shape
    y, x = np.arange(H, dtype=f32)[:, None], np.arange(W, dtype=f32)
    eigenvalue = 2 * np.cos(np.pi * y / H) + 2 * np.cos(np.pi * x / W) - 4
    eigenvalue[0, 0] = np.inf
    return idctn(dctn(f, norm="ortho") / eigenvalue.astype(f32), norm="ortho")


# %% task="fix_uncertain"


def fix_uncertain(mean, k, *, sigma_s):
    base = np.array(mean, np.float32)
    smooth = gaussian_filter1d(gaussian_filter1d(base, 2, axis=0), 2, axis=1, mode="mirror")
    u = np.log(np.maximum(k, 1)) / np.log(np.float32(np.sqrt(2 * np.pi) * sigma_s))
    uncertain = u < 1
    base[uncertain] = (u * base + (1 - u) * smooth)[uncertain]
    return base
