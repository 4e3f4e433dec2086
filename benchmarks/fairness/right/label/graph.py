"""Connected components of a sparse graph of neighbours."""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components


def label(mask):
    H, W = mask.shape
    number = np.arange(H * W).reshape(H, W)
    pairs = []
    for a, b in (
        (number[:, :-1], number[:, 1:]),
        (number[:-1], number[1:]),
        (number[:-1, :-1], number[1:, 1:]),
        (number[:-1, 1:], number[1:, :-1]),
    ):
        both = mask.ravel()[a] & mask.ravel()[b]
        pairs.append(np.stack([a[both], b[both]]))
    i, j = np.concatenate(pairs, axis=1)
    _, part = connected_components(
        coo_matrix((np.ones(len(i)), (i, j)), shape=(H * W, H * W)), directed=False
    )
    labels = np.zeros(H * W, int)
    inside = mask.ravel()
    labels[inside] = np.unique(part[inside], return_inverse=True)[1] + 1
    return labels.reshape(H, W)
