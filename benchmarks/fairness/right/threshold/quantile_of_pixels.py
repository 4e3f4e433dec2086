"""Spreads the histogram into sorted pixels and takes number ceil(q N); codes come as uint8."""

import numpy as np


def threshold(h, q):
    h = np.asarray(h).astype(np.int64)
    pixels = np.repeat(np.arange(h.size, dtype=np.uint8), h)
    number = np.ceil(np.asarray(q, dtype=float) * pixels.size).astype(int)
    ranked = np.concatenate([np.zeros(1, np.uint8), pixels])
    return ranked[np.clip(number, 0, pixels.size)]
