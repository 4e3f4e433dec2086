"""np.argsort of squared distances."""

import numpy as np


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    y, x = np.indices(shape) + 0.5
    d = (y - at[0] * shape[0]) ** 2 + (x - at[1] * shape[1]) ** 2
    k = max(int(np.rint(share * d.size)), 1)
    w = np.zeros(d.size)
    w[np.argsort(d, axis=None, kind="stable")[:k]] = 1.0
    return (w / w.sum()).reshape(shape)
