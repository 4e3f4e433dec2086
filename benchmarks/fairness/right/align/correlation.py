"""Counts all XORs of a level at once by scipy.signal's FFT; walks outwards from the middle image."""

import numpy as np
from scipy import signal


def _bytes(images, luma):
    if images.ndim == 4:
        weights = np.array([54, 183, 19]) if luma else np.array([0, 256, 0])
        images = ((images.astype(np.int64) * weights).sum(axis=-1) // 256).astype(images.dtype)
    if images.dtype == np.uint16:
        images = np.round(images / 257)
    return images.astype(np.uint8)


def threshold(h, q):
    running = np.cumsum(h) / np.sum(h)
    codes = np.argmax(running >= np.asarray(q)[..., None] - 1e-12, axis=-1)
    return codes


def exclusion(Y, t):
    return (Y > int(t) + 4) | (Y < int(t) - 4)


def shrink(Y):
    Y = Y[: Y.shape[0] // 2 * 2, : Y.shape[1] // 2 * 2].astype(np.int32)
    return ((Y[0::2, 0::2] + Y[1::2, 0::2] + Y[0::2, 1::2] + Y[1::2, 1::2] + 2) >> 2).astype(
        np.uint8
    )


def _share(a, b):
    """Return the share at which most pixels of the worse photograph vote on either side."""
    q = np.array([0.5, *[0.5 + s * k / 20 for k in range(1, 10) for s in (-1, 1)]])
    usable = np.ones(len(q), dtype=bool)
    for Y in (a, b):
        t = threshold(np.bincount(Y.ravel(), minlength=256), q)
        usable &= (t >= 10) & (t <= 245)
    if usable[0] or not usable.any():
        return q[0]
    return q[usable][np.argmin(np.abs(q[usable] - 0.5))]


def _counts(bit_a, vote_a, bit_b, vote_b):
    """Return the number of voting pixels that differ, for all offsets, [H - 1 + dy, W - 1 + dx]."""
    total = 0
    for x, y in ((bit_a & vote_a, ~bit_b & vote_b), (~bit_a & vote_a, bit_b & vote_b)):
        total = total + signal.fftconvolve(y.astype(float), x[::-1, ::-1].astype(float))
    return np.rint(total)


def _pair(a, b, bits):
    q = _share(a, b)
    levels = [(a, b)]
    while len(levels) < bits and min(levels[-1][0].shape) >= 14:
        levels.append(tuple(shrink(Y) for Y in levels[-1]))
    place = np.zeros(2, dtype=np.int64)
    around = np.array(
        [(0, 0), (-1, 0), (0, -1), (0, 1), (1, 0), (-1, -1), (-1, 1), (1, -1), (1, 1)]
    )
    for A, B in reversed(levels):
        H, W = A.shape
        ta, tb = (int(threshold(np.bincount(Y.ravel(), minlength=256), q)) for Y in (A, B))
        wrong = _counts(A > ta, exclusion(A, ta), B > tb, exclusion(B, tb))
        tried = 2 * place + around
        tried = tried[(np.abs(tried) < (H, W)).all(axis=1)]
        area = (H - np.abs(tried[:, 0])) * (W - np.abs(tried[:, 1]))
        shares = wrong[H - 1 + tried[:, 0], W - 1 + tried[:, 1]] / area
        place = tried[np.argmin(shares)]
    return place


def align(images, *, bits=6, luma=False):
    images = np.asarray(images)
    good = images.ndim == 3 or (images.ndim == 4 and images.shape[3] == 3)
    if not good or images.dtype not in (np.uint8, np.uint16) or 0 in images.shape:
        raise ValueError("images are not a stack of photographs")
    if bits < 1:
        raise ValueError("at least one level is needed")
    Y = _bytes(images, luma)
    order = np.lexsort((np.arange(len(Y)), Y.sum(axis=(1, 2), dtype=np.int64)))
    middle = len(order) // 2
    offsets = np.zeros((len(Y), 2), dtype=np.int64)
    for k in range(middle + 1, len(order)):
        offsets[order[k]] = offsets[order[k - 1]] + _pair(Y[order[k]], Y[order[k - 1]], bits)
    for k in range(middle - 1, -1, -1):
        offsets[order[k]] = offsets[order[k + 1]] + _pair(Y[order[k]], Y[order[k + 1]], bits)
    return offsets
