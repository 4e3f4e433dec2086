"""Rows of the prior below those of A."""

import numpy as np


def solve_map(A, b, sd):
    rows = np.vstack([A, np.diag(1 / sd)])
    return np.linalg.lstsq(rows, np.concatenate([b, 0 * sd]), rcond=None)[0]
