"""The products of the powers themselves."""

import numpy as np


def quadratic_form(blends, degree):
    V = np.concatenate([M for _, M in blends])[:, None] ** np.arange(degree + 1)
    return V.T @ V
