"""One system: a column for gamma, and a column for the intercept of each series."""

import numpy as np


def fit_exponent(ladders, *, alpha=0.0):
    rows, right = [], []
    for j, (series, R) in enumerate(ladders):
        for k, m in enumerate(series):
            row = np.zeros(1 + len(ladders))
            row[0] = k * np.log(R)
            row[1 + j] = 1
            rows.append(row)
            right.append(np.log(m - alpha))
    return np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)[0][0]
