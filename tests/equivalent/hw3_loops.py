"""Homework 3 pixel by pixel."""

# %%
import math
import struct

import numpy as np

# %% task="merge"


def hat(z):
    return z if z < 128 else 255 - z


def merge(images, times, g, w=None):
    images = np.asarray(images)
    stack = images if images.ndim == 4 else images[..., None]
    w = [hat(z) for z in range(256)] if w is None else list(w)
    B, shape = [math.log(t) for t in times], stack.shape[1:]
    curves = [[float(v) for v in (g if g.ndim == 1 else g[:, c])] for c in range(shape[2])]
    E = np.zeros(shape, np.float32)
    shortest, longest = B.index(min(B)), B.index(max(B))
    for c in range(shape[2]):
        curve = curves[c]
        levels = stack[..., c].reshape(len(B), -1).T.tolist()
        merged = []
        for Z in levels:
            total = sum(w[z] for z in Z)
            if total > 0:
                lE = sum(w[z] * (curve[z] - b) for z, b in zip(Z, B, strict=True)) / total
            elif Z[shortest] > 128:
                lE = curve[250] - B[shortest]
            else:
                lE = curve[1] - B[longest]
            merged.append(math.exp(lE))
        E[..., c] = np.reshape(merged, shape[:2])
    return E.reshape(images.shape[1:])


# %% task="bound"


def bound(Z, B, g, top, shown):
    E, flags = [], []
    for m in range(Z.shape[1]):
        lower = [g[top] - B[j] for j in range(len(B)) if shown[j, m] and Z[j, m] >= top]
        upper = [g[1] - B[j] for j in range(len(B)) if shown[j, m] and Z[j, m] == 0]
        flags.append((1 if lower else 0) + (2 if upper else 0) or 8)
        ends = ([max(lower)] if lower else []) + ([min(upper)] if upper else [])
        E.append(math.exp(sum(ends) / len(ends)) if ends else 0.0)
    return np.array(E), np.array(flags)


# %% task="to_bytes"


def to_bytes(E):
    H, W = E.shape[:2]
    data = b"PF" if E.ndim == 3 else b"Pf"
    data += b"\n" + str(W).encode() + b" " + str(H).encode() + b"\n-1.0\n"
    for y in range(H - 1, -1, -1):
        for value in np.ravel(E[y]):
            data += struct.pack("<f", float(value))
    return data


# %% task="from_bytes"


def from_bytes(data):
    words, at = [], 0
    while len(words) < 4:
        word = b""
        while not data[at : at + 1].isspace():
            word, at = word + data[at : at + 1], at + 1
        words.append(word)
        at += 1
    W, H, C = int(words[1]), int(words[2]), 3 if words[0] == b"PF" else 1
    order = "<" if float(words[3]) < 0 else ">"
    values = struct.unpack(f"{order}{W * H * C}f", data[at : at + 4 * W * H * C])
    E = np.zeros((H, W, C), np.float32)
    for k, value in enumerate(values):
        E[H - 1 - k // (W * C), k // C % W, k % C] = value
    return E if C == 3 else E[..., 0]


# %% task="to_pixels"


def to_pixels(E):
    pixels = np.zeros((*E.shape[:2], 4), np.uint8)
    for y in range(E.shape[0]):
        for x in range(E.shape[1]):
            top = float(max(E[y, x]))
            if top > 1e-32:
                _, e = math.frexp(top)
                pixels[y, x] = [*(int(float(v) / 2.0**e * 256) for v in E[y, x]), e + 128]
    return pixels


# %% task="to_radiance"


def to_radiance(pixels):
    E = np.zeros((*pixels.shape[:2], 3))
    for y, row in enumerate(pixels.tolist()):
        for x, (r, g, b, e) in enumerate(row):
            if e:
                E[y, x] = [m / 256 * 2.0 ** (e - 128) for m in (r, g, b)]
    return E
