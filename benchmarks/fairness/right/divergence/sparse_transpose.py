"""Minus the transpose of the sparse matrices of forward differences, from the left and from the right."""

import numpy as np
from scipy import sparse


def forward(n):
    """(n - 1, n): the steps from each place to the next, none across the end."""
    return sparse.eye_array(n - 1, n, k=1) - sparse.eye_array(n - 1, n)


def divergence(G):
    Gy, Gx = (np.asarray(part, dtype=float) for part in G)
    H, W = Gy.shape
    result = np.zeros((H, W))
    if H > 1:
        result -= forward(H).T @ Gy[:-1]
    if W > 1:
        result -= (forward(W).T @ Gx[:, :-1].T).T
    return result
