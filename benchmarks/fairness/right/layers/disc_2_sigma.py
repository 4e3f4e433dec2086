"""A disc of 2 sigma, padded by the picture mirrored at its edges; float32, a list of two."""

import numpy as np


def gaussian(d2, sigma):
    return np.exp(-d2 / (2 * sigma * sigma))


def layers(lL, *, sigma_s, sigma_r=0.4):
    l = np.asarray(lL, dtype=np.float32)
    H, W = l.shape
    r = int(np.ceil(2 * sigma_s))
    padded = np.pad(l, r, mode="symmetric")
    numerator = np.zeros_like(l)
    denominator = np.zeros_like(l)
    offsets = [
        (y, x)
        for y in range(-r, r + 1)
        for x in range(-r, r + 1)
        if y * y + x * x <= (2 * sigma_s) ** 2
    ]
    for y, x in offsets:
        other = padded[r + y : r + y + H, r + x : r + x + W]
        weight = np.float32(gaussian(y * y + x * x, sigma_s)) * gaussian((l - other) ** 2, sigma_r)
        numerator += weight * other
        denominator += weight
    base = numerator / denominator
    return [base, l - base]
