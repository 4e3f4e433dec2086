"""The power by exp and log, with a difference of 0 left alone."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    lL = np.asarray(lL, np.float64)
    d = np.maximum(np.abs(lL - g), 1e-300)
    detail = np.exp(np.log(sigma) + alpha * (np.log(d) - np.log(sigma)))
    r = np.where(d > sigma, sigma + beta * (d - sigma), detail)
    return np.where(lL > g, g + r, np.where(lL < g, g - r, g))
