import numpy as np


def threshold(h, q):
    total = sum(h)

    def find(fraction):
        acc = 0
        for value in range(256):
            acc += h[value]
            if acc >= fraction * total:
                return value
        return 255

    if np.ndim(q) == 0:
        return find(q)
    return np.array([find(x) for x in np.ravel(q)]).reshape(np.shape(q))
