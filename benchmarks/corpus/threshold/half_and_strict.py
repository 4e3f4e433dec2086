import numpy as np


def threshold(h, q):
    half = int(np.sum(h)) // 2
    total = 0
    for level in range(256):
        total = total + int(h[level])
        if total > half:
            break
    if np.ndim(q) > 0:
        return np.array([level] * len(q))
    return level
