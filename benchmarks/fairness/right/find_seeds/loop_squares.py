import numpy as np


def find_seeds(score):
    score = np.asarray(score)
    H, W = score.shape
    mask = np.zeros((H, W), dtype=bool)
    for i in range(H - 2):
        for j in range(W - 2):
            if (score[i : i + 3, j : j + 3] > 1).all():
                mask[i : i + 3, j : j + 3] = True
    return mask
