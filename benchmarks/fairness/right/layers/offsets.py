"""A loop over the offsets within 3 sigma; pixels outside do not count."""

import numpy as np


def layers(lL, *, sigma_s, sigma_r=0.4):
    l, r = np.asarray(lL, float), int(np.ceil(3 * sigma_s))
    (H, W), wide = l.shape, np.pad(l, int(np.ceil(3 * sigma_s)), constant_values=np.nan)
    above, below = np.zeros((H, W)), np.zeros((H, W))
    for dy in range(-r, r + 1):
        for dx in range(-r, r + 1):
            q = wide[r + dy : r + dy + H, r + dx : r + dx + W]
            k = np.exp(-(dy * dy + dx * dx) / (2 * sigma_s**2) - (l - q) ** 2 / (2 * sigma_r**2))
            k = np.where(np.isnan(q), 0, k)
            above, below = above + k * np.nan_to_num(q), below + k
    base = above / below
    return base, l - base
