import numpy as np


def find_seeds(score):
    over = np.asarray(score) > 1
    H, W = over.shape
    out = np.zeros((H, W), bool)
    if H < 3 or W < 3:
        return out
    full = np.ones((H - 2, W - 2), bool)
    for dy in range(3):
        for dx in range(3):
            full &= over[dy : dy + H - 2, dx : dx + W - 2]
    for dy in range(3):
        for dx in range(3):
            out[dy : dy + H - 2, dx : dx + W - 2] |= full
    return out
