import numpy as np


def threshold(h, q):
    cdf = np.cumsum(h) / np.sum(h)
    out = []
    for f in np.atleast_1d(q):
        k = 0
        while k < 255 and cdf[k] <= f:
            k = k + 1
        out.append(k)
    return out[0] if np.ndim(q) == 0 else np.array(out)
