import numpy as np


def hat(n=256):
    w = np.concatenate([np.arange(1, n // 2 + 1), np.arange(n // 2, 0, -1)])
    return w
