import numpy as np


def threshold(h, q):
    # median threshold of the MTB
    count = 0
    half = np.sum(h) / 2
    med = 0
    for i in range(len(h)):
        count += h[i]
        if count >= half:
            med = i
            break
    return np.full(np.shape(q), med) if np.ndim(q) else med
