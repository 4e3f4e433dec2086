"""All centered values in two long vectors; a 1-element array as the answer."""

import numpy as np


def fit_exponent(ladders, *, alpha=0.0):
    x, y = [], []
    for series, R in ladders:
        k = np.arange(len(series)) - (len(series) - 1) / 2
        ln = np.log(series - alpha)
        x.extend(k * np.log(R))
        y.extend(ln - ln.mean())
    return np.array([np.dot(x, y) / np.dot(x, x)])
