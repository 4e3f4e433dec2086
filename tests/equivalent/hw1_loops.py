"""Homework 1 in plain loops with Python's math module."""

# %%
import math

import numpy as np

# %% task="ev"


def ev(F, T, *, S=100.0):
    if np.ndim(T):
        return np.array([ev(F, float(t), S=S) for t in T])
    return math.log2(F * F / T) - math.log2(S / 100)


# %% task="equivalent_time"


def equivalent_time(T, F, F_new, *, S=100, S_new=100):
    light = T / F**2 * S
    return light * F_new**2 / S_new


# %% task="count"


def count(scene, usable, overlap):
    n, reach = 1, usable
    while reach < scene - 1e-9:
        n, reach = n + 1, reach + usable - overlap
    return n


# %% task="threshold"


def threshold(h, q):
    if np.ndim(q):
        return [threshold(h, one) for one in q]
    total, below = sum(int(n) for n in h), 0
    for code, n in enumerate(h):
        below += int(n)
        if below >= q * total:
            return code
    return 255


# %% task="exclusion"


def exclusion(Y, t):
    kept = np.zeros(Y.shape, bool)
    for y in range(Y.shape[0]):
        for x in range(Y.shape[1]):
            kept[y, x] = abs(int(Y[y, x]) - t) > 4
    return kept


# %% task="shrink"


def shrink(Y):
    half = np.zeros((Y.shape[0] // 2, Y.shape[1] // 2), np.uint8)
    for y in range(half.shape[0]):
        for x in range(half.shape[1]):
            four = sum(int(Y[2 * y + i, 2 * x + j]) for i in (0, 1) for j in (0, 1))
            half[y, x] = (four + 2) // 4
    return half


# %% task="shift"


def shift(images, offsets):
    H, W = images.shape[1:3]
    top, left = max(0, *(int(o[0]) for o in offsets)), max(0, *(int(o[1]) for o in offsets))
    bottom, right = (
        H + min(0, *(int(o[0]) for o in offsets)),
        W + min(0, *(int(o[1]) for o in offsets)),
    )
    moved = np.zeros((len(images), bottom - top, right - left, *images.shape[3:]), images.dtype)
    for j, (dy, dx) in enumerate(offsets):
        for y in range(top, bottom):
            for x in range(left, right):
                moved[j, y - top, x - left] = images[j, y - dy, x - dx]
    return moved


# %% task="align"


def halved(Y):
    Y = Y[: Y.shape[0] // 2 * 2, : Y.shape[1] // 2 * 2].astype(int)
    return (Y[::2, ::2] + Y[1::2, ::2] + Y[::2, 1::2] + Y[1::2, 1::2] + 2) // 4


def disagreement(A, B, dy, dx):
    H, W = A.shape
    if abs(dy) >= H or abs(dx) >= W:
        return 1.0
    a = A[max(dy, 0) : H + min(dy, 0), max(dx, 0) : W + min(dx, 0)]
    b = B[max(-dy, 0) : H + min(-dy, 0), max(-dx, 0) : W + min(-dx, 0)]
    ta, tb = np.median(A), np.median(B)
    compared = (abs(a - ta) > 4) & (abs(b - tb) > 4)
    return np.sum(((a > ta) != (b > tb)) & compared) / max(1, np.sum(compared))


def offset_of(fixed, moving, bits):
    fixed, moving = fixed.astype(int), moving.astype(int)
    dy = dx = 0
    if bits > 1 and min(fixed.shape) >= 16:
        dy, dx = offset_of(halved(fixed), halved(moving), bits - 1)
    dy, dx = 2 * dy, 2 * dx
    best, found = disagreement(fixed, moving, dy, dx), (dy, dx)
    for i, j in ((-1, 0), (0, -1), (0, 1), (1, 0), (-1, -1), (-1, 1), (1, -1), (1, 1)):
        error = disagreement(fixed, moving, dy + i, dx + j)
        if error < best - 1e-12:
            best, found = error, (dy + i, dx + j)
    return found


def align(images, *, bits=6, luma=False):
    gray = [image[..., 1] if image.ndim == 3 else image for image in images]
    order = sorted(range(len(gray)), key=lambda j: gray[j].mean())
    offsets = np.zeros((len(gray), 2), int)
    middle = len(gray) // 2
    for k in range(middle + 1, len(gray)):
        offsets[order[k]] = offsets[order[k - 1]] + offset_of(
            gray[order[k - 1]], gray[order[k]], bits
        )
    for k in range(middle - 1, -1, -1):
        offsets[order[k]] = offsets[order[k + 1]] + offset_of(
            gray[order[k + 1]], gray[order[k]], bits
        )
    return offsets
