"""Homework 3 in float32."""

# %%
import numpy as np
from scipy.ndimage import binary_fill_holes, label as connected
from scipy.signal import convolve2d

f32 = np.float32

# %% task="merge"


def merge(images, times, g, w=None):
    g = np.asarray(g, f32)
    w = (
        np.minimum(np.arange(256), 255 - np.arange(256)).astype(f32)
        if w is None
        else np.asarray(w, f32)
    )
    B = np.log(np.asarray(times, f32))
    above, below = np.zeros(images.shape[1:], f32), np.zeros(images.shape[1:], f32)
    least, most = np.full(images.shape[1:], -np.inf, f32), np.full(images.shape[1:], np.inf, f32)
    for Z, b in zip(images, B, strict=True):
        curve = (
            g[Z]
            if g.ndim == 1
            else np.take_along_axis(g, Z.reshape(-1, 3).astype(int), axis=0).reshape(Z.shape)
        )
        usable = (Z > 0) & (Z <= 250)
        above += usable * w[Z] * (curve - b)
        below += usable * w[Z]
        top, low = (g[251], g[1])
        least = np.where(Z > 250, np.maximum(least, top - b), least)
        most = np.where(Z == 0, np.minimum(most, low - b), most)
    bound = np.where(np.isfinite(most), most, least)
    bound = np.where(np.isfinite(most) & np.isfinite(least), (most + least) / f32(2), bound)
    return np.exp(np.where(below > 0, above / np.maximum(below, f32(1e-12)), bound)).astype(f32)


# %% task="bound"


def bound(Z, B, g, top, shown):
    g, B = g.astype(f32), B.astype(f32)[:, None]
    lower = np.max(np.where(shown & (Z >= top), g[top] - B, f32(-np.inf)), axis=0)
    upper = np.min(np.where(shown & (Z == 0), g[1] - B, f32(np.inf)), axis=0)
    clipped, dark = lower > -np.inf, upper < np.inf
    lE = np.zeros(Z.shape[1], f32)
    lE[clipped] += lower[clipped]
    lE[dark] += upper[dark]
    lE[clipped & dark] /= f32(2)
    flags = clipped.astype(f32) + f32(2) * dark
    flags[~(clipped | dark)] = 8
    return np.where(clipped | dark, np.exp(lE), f32(0)), flags


# %% task="to_bytes"


def to_bytes(E):
    E = np.asarray(E, f32)
    kind = "PF" if E.ndim == 3 else "Pf"
    return f"{kind}\n{E.shape[1]} {E.shape[0]}\n-1\n".encode() + np.flipud(E).tobytes()


# %% task="from_bytes"


def from_bytes(data):
    import re

    header = re.match(rb"(P[Ff])\s+(\d+)\s+(\d+)\s+(\S+)\s", data)
    kind, W, H, scale = header.groups()
    W, H = int(W), int(H)
    values = np.frombuffer(data, f32, offset=header.end())
    if float(scale) > 0:
        values = values.byteswap()
    return np.flipud(
        values.reshape(H, W, -1).squeeze(-1) if kind == b"Pf" else values.reshape(H, W, 3)
    )


# %% task="to_pixels"


def to_pixels(E):
    brightest = E.max(axis=2).astype(f32)
    with np.errstate(divide="ignore"):
        e = np.floor(np.log2(brightest)) + f32(1)
    e = np.where(brightest > 1e-32, e, f32(-128))
    m = np.floor(E * np.exp2(8 - e.astype(float))[..., None])
    return np.concatenate(
        [np.where(brightest[..., None] > 1e-32, m, 0), e[..., None] + 128], axis=2
    ).astype(f32)


# %% task="to_radiance"


def to_radiance(pixels):
    m, e = pixels[..., :3].astype(f32), pixels[..., 3:].astype(f32)
    return np.where(e > 0, m / f32(256) * np.exp2(e - f32(128)), f32(0))


# %% task="dilate"


def dilate(mask, margin):
    H, W = mask.shape
    padded = np.pad(mask, margin)
    wide = np.zeros((H, W), bool)
    for dy in range(2 * margin + 1):
        for dx in range(2 * margin + 1):
            if np.hypot(dy - margin, dx - margin) <= margin:
                wide |= padded[dy : dy + H, dx : dx + W]
    return binary_fill_holes(wide).astype(np.uint8)


# %% task="label"


def label(mask):
    labels, _ = connected(mask, structure=np.ones((3, 3)))
    return labels


# %% task="decode_half"


def decode_half(bits):
    b = bits.astype(np.uint32)
    sign, e, m = (b & 0x8000) << 16, (b >> 10) & 31, b & 1023
    exponent = np.where(e == 31, 255, e + 112).astype(np.uint32)
    word = sign | exponent << 23 | m << 13
    value = word.view(np.float32)
    small = np.float32(2.0**-24) * m.astype(np.float32)
    return np.where(e == 0, np.where(sign > 0, -small, small), value)


# %% task="weighted_variance"


def weighted_variance(x, w):
    x, w = np.float32(x), np.float32(w)
    share = w / np.maximum(w.sum(0, keepdims=True), np.float32(1e-20))
    mean = np.einsum("phw,phw->hw", share, x)
    return np.einsum("phw,phw->hw", share, np.square(x - mean))


# %% task="find_seeds"


def find_seeds(score):
    ones = np.ones((3, 3))
    whole = convolve2d((score > 1) * 1.0, ones, mode="valid") > 8.5
    return convolve2d(whole * 1.0, ones, mode="full") > 0.5


# %% task="ratio_steps"


def ratio_steps(found, *, limit=9.0, tolerance=1e-6, rounds=100):
    x, y, v = found
    vx, vy = v * x, v * y
    used = np.arange(len(x)) >= 0
    k = (vx @ vy) / (vx @ vx)
    V = np.var(vy - k * vx) + np.mean(vy - k * vx) ** 2
    states = [(k, used.copy(), V)]
    change, i = np.inf, 0
    while i < rounds and not change < tolerance:
        used = np.abs(vy - k * vx) <= np.sqrt(limit * V)
        a, b = vx[used], vy[used]
        change, k = abs(a @ b / (a @ a) - k), a @ b / (a @ a)
        V = np.dot(b - k * a, b - k * a) / used.sum()
        states.append((k, used.copy(), V))
        i += 1
    yield from states
