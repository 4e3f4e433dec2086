"""polyfit of each series, weighted by its sum of squares."""

import numpy as np


def fit_exponent(ladders, *, alpha=0.0):
    slopes, weights = [], []
    for series, R in ladders:
        k = np.arange(len(series))
        slopes.append(np.polyfit(k, np.log(np.asarray(series) - alpha), 1)[0] / np.log(R))
        weights.append(np.log(R) ** 2 * np.sum((k - k.mean()) ** 2))
    return np.average(slopes, weights=weights)
