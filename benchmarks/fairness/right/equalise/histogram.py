"""numpy's histogram of the clipped logarithms."""

import numpy as np


def equalise(L, bins=1024, limit=4.0):
    s = np.sort(L.ravel().astype(float))
    low, high = s[1], s[-2]
    if high < 2 * low:
        k = np.sqrt(2 * low / high)
        low, high = low / k, high * k
    b = np.clip(np.log(L.astype(float)), np.log(low), np.log(high))
    h, edges = np.histogram(b, bins=bins, range=(np.log(low), np.log(high)))
    h = h / L.size
    top = limit / bins
    cut = np.minimum(h, top)
    room = top - cut
    if room.sum() > 0:
        cut = cut + room * (1 - cut.sum()) / room.sum()
    P = np.interp(b, edges, np.concatenate([[0], np.cumsum(cut)]))
    return np.where(P <= 0.04045, P / 12.92, ((P + 0.055) / 1.055) ** 2.4)
