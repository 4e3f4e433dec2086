"""Pixel after pixel a window of 4 sigma, cut where the picture ends, with separable spatial weights."""

import numpy as np


class Layers(tuple):
    """The sheet's pair, with names."""

    base = property(lambda self: self[0])
    detail = property(lambda self: self[1])


def layers(lL, *, sigma_s, sigma_r=0.4):
    lL = np.asarray(lL, float)
    H, W = lL.shape
    reach = int(4 * sigma_s) + 1
    bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma_s) ** 2)
    base = np.empty_like(lL)
    for y in range(H):
        top, bottom = max(y - reach, 0), min(y + reach + 1, H)
        by = bell[top - y + reach : bottom - y + reach]
        for x in range(W):
            left, right = max(x - reach, 0), min(x + reach + 1, W)
            bx = bell[left - x + reach : right - x + reach]
            around = lL[top:bottom, left:right]
            near = np.exp(-0.5 * ((around - lL[y, x]) / sigma_r) ** 2)
            base[y, x] = (by @ (near * around) @ bx) / (by @ near @ bx)
    return Layers((base, lL - base))
