"""Numerator and denominator added up over the series."""

import numpy as np


def fit_exponent(ladders, alpha=0.0):
    above = below = 0
    for series, R in ladders:
        x = np.arange(len(series)) * np.log(R)
        y = np.log(series - alpha)
        above += ((x - x.mean()) * (y - y.mean())).sum()
        below += ((x - x.mean()) ** 2).sum()
    return above / below
