"""Homework 3 in float32."""

# %%
import numpy as np

f32 = np.float32

# %% task="merge"


def merge(images, times, g, w=None):
    g = np.asarray(g, f32)
    w = np.minimum(np.arange(256), 255 - np.arange(256)).astype(f32) if w is None else np.asarray(w, f32)
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
    kind, size, scale = data.split(b"\n", 3)[:3]
    W, H = (int(n) for n in size.split())
    start = len(kind) + len(size) + len(scale) + 3
    values = np.frombuffer(data, f32, offset=start)
    if float(scale) > 0:
        values = values.byteswap()
    return np.flipud(values.reshape(H, W, -1).squeeze(-1) if kind == b"Pf" else values.reshape(H, W, 3))


# %% task="to_pixels"


def to_pixels(E):
    brightest = E.max(axis=2).astype(f32)
    with np.errstate(divide="ignore"):
        e = np.floor(np.log2(brightest)) + f32(1)
    e = np.where(brightest > 1e-32, e, f32(-128))
    m = np.floor(E * np.exp2(8 - e.astype(float))[..., None])
    return np.concatenate([np.where(brightest[..., None] > 1e-32, m, 0), e[..., None] + 128], axis=2).astype(
        f32
    )


# %% task="to_radiance"


def to_radiance(pixels):
    m, e = pixels[..., :3].astype(f32), pixels[..., 3:].astype(f32)
    return np.where(e > 0, m / f32(256) * np.exp2(e - f32(128)), f32(0))
