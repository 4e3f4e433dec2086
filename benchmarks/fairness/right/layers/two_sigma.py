"""Within 2 sigma, a round window."""

import numpy as np


def layers(lL, *, sigma_s, sigma_r=0.4):
    l = np.asarray(lL, np.float32)
    r, (H, W) = int(2 * sigma_s), l.shape
    top, bottom = np.zeros_like(l), np.zeros_like(l)
    for dy in range(-r, r + 1):
        for dx in range(-r, r + 1):
            if dy * dy + dx * dx > r * r:
                continue
            p = (slice(max(0, -dy), H - max(0, dy)), slice(max(0, -dx), W - max(0, dx)))
            q = (slice(max(0, dy), H - max(0, -dy)), slice(max(0, dx), W - max(0, -dx)))
            k = np.exp(-(dy**2 + dx**2) / (2 * sigma_s**2)) * np.exp(
                -((l[p] - l[q]) ** 2) / (2 * sigma_r**2)
            )
            top[p] += k * l[q]
            bottom[p] += k
    return top / bottom, l - top / bottom
