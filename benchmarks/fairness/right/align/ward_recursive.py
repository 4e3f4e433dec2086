"""Ward's recursion over levels; of two middle images the brighter; shares are tried in a fixed order."""

import numpy as np

SHARES = (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.1, 0.9, 0.05, 0.95)
SMALLEST = 6


def threshold(h, q):
    running = np.cumsum(h)
    return int(np.searchsorted(running, q * running[-1]))


def exclusion(Y, t):
    return np.abs(Y.astype(np.int16) - t) > 4


def shrink(Y):
    h, w = Y.shape[0] // 2, Y.shape[1] // 2
    sums = Y[: 2 * h, : 2 * w].reshape(h, 2, w, 2).sum(axis=(1, 3), dtype=np.uint16)
    return ((sums + 2) // 4).astype(np.uint8)


def _histogram(Y):
    return np.bincount(Y.ravel(), minlength=256)


def _share(a, b):
    ha, hb = _histogram(a), _histogram(b)
    room = [min(min(threshold(h, q), 255 - threshold(h, q)) for h in (ha, hb)) for q in SHARES]
    for q, free in zip(SHARES, room):
        if free > 8:
            return q
    return SHARES[int(np.argmax(room))]


def _offset(a, b, q, bits):
    """Return how far a must move to lie on b."""
    if bits > 1 and min(a.shape) // 2 >= SMALLEST:
        cy, cx = (2 * v for v in _offset(shrink(a), shrink(b), q, bits - 1))
    else:
        cy, cx = 0, 0
    ta, tb = threshold(_histogram(a), q), threshold(_histogram(b), q)
    bit_a, bit_b, vote_a, vote_b = a > ta, b > tb, exclusion(a, ta), exclusion(b, tb)
    H, W = a.shape
    best, found = None, (cy, cx)
    for y, x in sorted(np.ndindex(3, 3), key=lambda yx: yx != (1, 1)):
        dy, dx = cy + y - 1, cx + x - 1
        if abs(dy) >= H or abs(dx) >= W:
            continue
        on_b = np.s_[max(dy, 0) : H + min(dy, 0), max(dx, 0) : W + min(dx, 0)]
        on_a = np.s_[max(-dy, 0) : H + min(-dy, 0), max(-dx, 0) : W + min(-dx, 0)]
        wrong = (bit_a[on_a] ^ bit_b[on_b]) & vote_a[on_a] & vote_b[on_b]
        share = np.count_nonzero(wrong) / wrong.size
        if best is None or share < best:
            best, found = share, (dy, dx)
    return found


def align(images, *, bits=6, luma=False):
    images = np.asarray(images)
    if images.ndim not in (3, 4) or (images.ndim == 4 and images.shape[3] != 3) or images.size == 0:
        raise ValueError("images must be (P, H, W) or (P, H, W, 3)")
    if images.dtype not in (np.uint8, np.uint16):
        raise ValueError("images must be uint8 or uint16")
    if bits < 1:
        raise ValueError("bits must be at least 1")
    if images.dtype == np.uint16:
        images = (images >> 8).astype(np.uint8)
    if images.ndim == 4:
        if luma:
            images = (
                (images.astype(np.uint32) @ np.array([54, 183, 19], dtype=np.uint32)) >> 8
            ).astype(np.uint8)
        else:
            images = images[..., 1]
    order = np.argsort(images.mean(axis=(1, 2)), kind="stable")
    offsets = np.zeros((len(images), 2), dtype=np.int64)
    for dark, bright in zip(order[:-1], order[1:]):
        a, b = images[bright], images[dark]
        offsets[bright] = offsets[dark] + _offset(a, b, _share(a, b), bits)
    return offsets - offsets[order[len(order) // 2]]
