"""Homework 3, one pixel at a time."""

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
        while data[at : at + 1].isspace():
            at += 1
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


# %% task="dilate"


def dilate(mask, margin):
    H, W = mask.shape
    wide = np.zeros((H + 2, W + 2), bool)
    for y, x in zip(*np.nonzero(mask), strict=True):
        for dy in range(-margin, margin + 1):
            for dx in range(-margin, margin + 1):
                if dy * dy + dx * dx <= margin * margin and 0 <= y + dy < H and 0 <= x + dx < W:
                    wide[y + dy + 1, x + dx + 1] = True
    outside, waiting = np.zeros_like(wide), [(0, 0)]
    while waiting:
        y, x = waiting.pop()
        if 0 <= y < H + 2 and 0 <= x < W + 2 and not wide[y, x] and not outside[y, x]:
            outside[y, x] = True
            waiting += [(y + 1, x), (y - 1, x), (y, x + 1), (y, x - 1)]
    return ~outside[1:-1, 1:-1]


# %% task="label"


def label(mask):
    labels, count = np.zeros(mask.shape, int), 0
    for start in np.argwhere(mask):
        if labels[tuple(start)]:
            continue
        count += 1
        waiting = [tuple(start)]
        while waiting:
            y, x = waiting.pop()
            if (
                0 <= y < mask.shape[0]
                and 0 <= x < mask.shape[1]
                and mask[y, x]
                and not labels[y, x]
            ):
                labels[y, x] = count
                waiting += [(y + a, x + b) for a in (-1, 0, 1) for b in (-1, 0, 1)]
    return labels


# %% task="decode_half"


def one(word):
    text = f"{int(word):016b}"
    s, e, m = int(text[0], 2), int(text[1:6], 2), int(text[6:], 2)
    if e == 31:
        return float("nan") if m else (-1) ** s * float("inf")
    if e == 0:
        return (-1) ** s * 2**-14 * m / 1024
    return (-1) ** s * 2 ** (e - 15) * (1 + m / 1024)


def decode_half(bits):
    return np.vectorize(one, otypes=[float])(bits)


# %% task="weighted_variance"


def weighted_variance(x, w):
    P, H, W = x.shape
    v = np.zeros((H, W))
    for i in range(H):
        for j in range(W):
            s = sum(w[:, i, j])
            if s == 0:
                continue
            m = sum(w[p, i, j] * x[p, i, j] for p in range(P)) / s
            v[i, j] = sum(w[p, i, j] * (x[p, i, j] - m) ** 2 for p in range(P)) / s
    return v


# %% task="find_seeds"


def find_seeds(score):
    H, W = score.shape
    mask = np.zeros((H, W), bool)
    for y in range(H - 2):
        for x in range(W - 2):
            if all(score[y + i, x + j] > 1 for i in range(3) for j in range(3)):
                mask[y : y + 3, x : x + 3] = True
    return mask


# %% task="ratio_steps"


def ratio_steps(found, *, limit=9.0, tolerance=1e-6, rounds=100):
    pairs = list(zip(*(one.tolist() for one in found), strict=True))
    inside = [True] * len(pairs)
    k = V = math.nan
    for turn in range(rounds + 1):
        before = k
        if turn:
            inside = [(v * (y - k * x)) ** 2 <= limit * V for x, y, v in pairs]
        top = bottom = 0.0
        for (x, y, v), counts in zip(pairs, inside, strict=True):
            if counts:
                top += v * v * x * y
                bottom += v * v * x * x
        k = top / bottom
        errors = [
            (v * (y - k * x)) ** 2
            for (x, y, v), counts in zip(pairs, inside, strict=True)
            if counts
        ]
        V = sum(errors) / len(errors)
        yield k, list(inside), V
        if abs(k - before) < tolerance:
            return
