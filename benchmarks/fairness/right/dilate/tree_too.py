"""Nearest pixel of the mask by a tree; holes by connected components of a graph of the rest."""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree


def dilate(mask, margin):
    mask = np.asarray(mask, bool)
    if not mask.any():
        return np.zeros(mask.shape, bool)
    every = np.argwhere(np.ones(mask.shape, bool))
    d, _ = cKDTree(np.argwhere(mask)).query(every)
    wide = (d <= margin + 1e-9).reshape(mask.shape)
    rest = np.pad(~wide, 1, constant_values=True)
    i = np.arange(rest.size).reshape(rest.shape)
    down, right = rest[1:] & rest[:-1], rest[:, 1:] & rest[:, :-1]
    a = np.concatenate([i[:-1][down], i[:, :-1][right]])
    b = np.concatenate([i[1:][down], i[:, 1:][right]])
    _, part = connected_components(
        sparse.coo_matrix((np.ones(a.size), (a, b)), (rest.size,) * 2), directed=False
    )
    part = part.reshape(rest.shape)
    return (part != part[0, 0])[1:-1, 1:-1]
