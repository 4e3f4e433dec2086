import numpy as np


def shrink(Y):
    h, w = Y.shape
    h2, w2 = h // 2, w // 2
    small = np.zeros((h2, w2))
    img = Y.astype(float)
    for i in range(h2):
        for j in range(w2):
            small[i, j] = img[2 * i : 2 * i + 2, 2 * j : 2 * j + 2].mean()
    return np.round(small).astype(np.uint8)
