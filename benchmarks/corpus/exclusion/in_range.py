import numpy as np


def exclusion(Y, t):
    Y = Y.astype(int)
    eb = np.zeros(Y.shape, dtype=np.uint8)
    for i in range(Y.shape[0]):
        for j in range(Y.shape[1]):
            if t - 4 <= Y[i, j] <= t + 4:
                eb[i, j] = 255
            else:
                eb[i, j] = 0
    return eb > 0
