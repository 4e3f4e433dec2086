"""The formula, with the fractions as they stand on the sheet."""

import numpy as np


def pq(FD):
    m1, m2 = 2610 / 16384, 128 * 2523 / 4096
    c1, c2, c3 = 3424 / 4096, 32 * 2413 / 4096, 32 * 2392 / 4096
    Y = np.asarray(FD) / 10000
    return ((c1 + c2 * Y**m1) / (1 + c3 * Y**m1)) ** m2
