"""The histogram, padded with two zeros; float32."""

import numpy as np


def contrast(block):
    I, _ = np.histogram(block, bins=256, range=(-0.5, 255.5))
    p = np.pad(I, 2).astype(np.float32)
    s = sum(p[k : k + 256] for k in range(5)) / 5
    i = np.arange(256, dtype=np.float32)
    M = np.dot(i, s) / s.sum()
    return np.float32(np.dot(np.abs(i - M), s) / s.sum())
