"""The nearest pixel is taken, again and again."""

import numpy as np


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    y, x = np.mgrid[: shape[0], : shape[1]]
    d = np.hypot(y + 0.5 - at[0] * shape[0], x + 0.5 - at[1] * shape[1])
    w = np.zeros(shape)
    count = max(1, int(round(share * w.size)))
    for _ in range(count):
        nearest = np.unravel_index(np.argmin(np.where(w > 0, np.inf, d)), shape)
        w[nearest] = 1
    return w / count
