"""Shares are of the voting pixels of the overlap; the nine offsets go through min with a key."""

import numpy as np
from scipy import ndimage


def shrink(Y):
    Y = Y[: len(Y) - len(Y) % 2, : Y.shape[1] - Y.shape[1] % 2]
    mean = ndimage.uniform_filter(Y.astype(float), size=2, mode="nearest", origin=-1)[::2, ::2]
    return np.rint(mean).astype(np.uint8)


def exclusion(Y, t):
    return ~np.isin(Y, np.arange(max(t - 4, 0), min(t + 4, 255) + 1))


def threshold(h, q):
    return int(np.flatnonzero(np.cumsum(h) >= q * np.sum(h))[0])


def histogram(Y):
    return np.histogram(Y, bins=256, range=(0, 256))[0]


def best_share(a, b):
    def clipped(q):
        codes = [threshold(histogram(Y), q) for Y in (a, b)]
        return max(0, 12 - min(codes), max(codes) - 243)

    shares = [0.5, 0.45, 0.55, 0.35, 0.65, 0.25, 0.75, 0.15, 0.85, 0.08, 0.92]
    return min(shares, key=lambda q: (clipped(q), abs(q - 0.5)))


def overlap(a, b, dy, dx):
    """Return the pixels that a, moved by (dy, dx), and b have in common."""
    H, W = b.shape
    rows, columns = slice(max(dy, 0), min(H, H + dy)), slice(max(dx, 0), min(W, W + dx))
    back = slice(rows.start - dy, rows.stop - dy), slice(columns.start - dx, columns.stop - dx)
    return a[back], b[rows, columns]


def quality(maps, votes, dy, dx):
    if abs(dy) >= maps[0].shape[0] or abs(dx) >= maps[0].shape[1]:
        return 1.0
    a, b = overlap(*maps, dy, dx)
    va, vb = overlap(*votes, dy, dx)
    both = va & vb
    return np.count_nonzero(a[both] != b[both]) / max(np.count_nonzero(both), 1)


def refine(pair, q, start):
    ts = [threshold(histogram(Y), q) for Y in pair]
    maps = [t < Y for Y, t in zip(pair, ts)]
    votes = [exclusion(Y, t) for Y, t in zip(pair, ts)]
    nine = [(start[0] + i, start[1] + j) for i in (0, -1, 1) for j in (0, -1, 1)]
    return min(nine, key=lambda o: quality(maps, votes, *o))


def offset(pair, bits):
    q = best_share(*pair)
    pyramid = [pair]
    while len(pyramid) < bits and min(pyramid[-1][0].shape) > 11:
        pyramid.append([shrink(Y) for Y in pyramid[-1]])
    place = (0, 0)
    for level in pyramid[::-1]:
        place = refine(level, q, (2 * place[0], 2 * place[1]))
    return np.array(place, dtype=np.int64)


def align(images, *, bits=6, luma=False):
    images = np.asarray(images)
    if images.dtype not in (np.dtype("u1"), np.dtype("u2")) or images.size == 0:
        raise ValueError("photographs must be uint8 or uint16")
    if images.ndim == 4 and images.shape[-1] == 3:
        R, G, B = np.moveaxis(images.astype(np.uint32), -1, 0)
        gray = (54 * R + 183 * G + 19 * B) >> 8 if luma else G
    elif images.ndim == 3:
        gray = images
    else:
        raise ValueError("expected a stack of photographs")
    if not bits >= 1:
        raise ValueError("bits must be at least 1")
    gray = (gray >> (8 * images.itemsize - 8)).astype(np.uint8)
    order = np.argsort(images.reshape(len(images), -1).mean(axis=1), kind="stable")
    where = {int(order[0]): np.zeros(2, dtype=np.int64)}
    for before, now in zip(order[:-1].tolist(), order[1:].tolist()):
        where[now] = where[before] + offset((gray[now], gray[before]), bits)
    zero = where[int(order[len(order) // 2])]
    return np.array([where[p] - zero for p in range(len(images))])
