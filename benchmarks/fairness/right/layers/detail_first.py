"""Sums the weighted differences l(q) - l(p) of each pair of pixels once, for both; base = lL - detail."""

import numpy as np


def halfplane(r):
    yield from ((0, x) for x in range(1, r + 1))
    yield from ((y, x) for y in range(1, r + 1) for x in range(-r, r + 1))


def layers(lL, *, sigma_s, sigma_r=0.4):
    lL = np.asarray(lL)
    l = lL.astype(float)
    H, W = l.shape
    pull = np.zeros_like(l)
    total = np.ones_like(l)
    for y, x in halfplane(int(np.floor(3 * sigma_s))):
        if y >= H or abs(x) >= W:
            continue
        a = np.s_[: H - y, max(-x, 0) : W - max(x, 0)]
        b = np.s_[y:, max(x, 0) : W + min(x, 0)]
        difference = l[b] - l[a]
        w = np.exp(-0.5 * (y * y + x * x) / sigma_s**2 - 0.5 * difference**2 / sigma_r**2)
        pull[a] += w * difference
        pull[b] -= w * difference
        total[a] += w
        total[b] += w
    detail = (-pull / total).astype(lL.dtype if lL.dtype.kind == "f" else float)
    return lL - detail, detail
