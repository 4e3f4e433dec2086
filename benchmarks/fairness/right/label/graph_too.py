"""scipy's connected components of a graph of the mask's pixels."""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components


def label(mask):
    mask = np.asarray(mask, bool)
    n = int(mask.sum())
    out = np.zeros(mask.shape, int)
    if n == 0:
        return out
    i = np.full(mask.shape, -1)
    i[mask] = np.arange(n)
    p = np.pad(i, 1, constant_values=-1)
    c = p[1:-1, 1:-1]
    a, b = [], []
    for q in (p[1:-1, 2:], p[2:, 1:-1], p[2:, 2:], p[2:, :-2]):
        both = (c >= 0) & (q >= 0)
        a.append(c[both])
        b.append(q[both])
    a, b = np.concatenate(a), np.concatenate(b)
    out[mask] = (
        connected_components(sparse.coo_matrix((np.ones(a.size), (a, b)), (n, n)), directed=False)[
            1
        ]
        + 1
    )
    return out
