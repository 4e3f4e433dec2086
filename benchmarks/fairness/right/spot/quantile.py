"""The radius is halved until so many pixels lie inside."""

import numpy as np


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    rows, columns = np.meshgrid(*(np.linspace(0.5, n - 0.5, n) for n in shape), indexing="ij")
    d = np.hypot(rows - at[0] * shape[0], columns - at[1] * shape[1])
    wanted = max(round(share * shape[0] * shape[1]), 1)
    low, high = 0.0, float(d.max())
    for _ in range(60):
        r = (low + high) / 2
        low, high = (low, r) if (d <= r).sum() >= wanted else (r, high)
    return np.where(d <= high, 1.0, 0.0) / (d <= high).sum()
