"""numpy's sliding windows over a padded c."""

import numpy as np


def peaks(c, count):
    padded = np.pad(c, 2, constant_values=-np.inf)
    top = np.lib.stride_tricks.sliding_window_view(padded, (5, 5)).max(axis=(2, 3))
    flat = np.where((c >= top) & (c > 0), c, -np.inf).ravel()
    order = np.argsort(-flat)[:count]
    order = order[np.isfinite(flat[order])]
    y, x = np.unravel_index(order, c.shape)
    return np.column_stack([y - c.shape[0] // 2, x - c.shape[1] // 2])
