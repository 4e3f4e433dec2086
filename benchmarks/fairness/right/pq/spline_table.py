"""A table of 4,097 codes over even steps of Y to the m1, read between its entries with a cubic spline."""

import numpy as np
from scipy.interpolate import CubicSpline


def pq(FD):
    y = np.linspace(0, 1, 4097)
    table = ((3424 / 4096 + 32 * 2413 / 4096 * y) / (1 + 32 * 2392 / 4096 * y)) ** (
        128 * 2523 / 4096
    )
    read = CubicSpline(y, table)
    return read((np.asarray(FD, dtype=float) / 10_000) ** (2610 / 16384))
