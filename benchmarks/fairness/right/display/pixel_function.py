"""A Python function of one pixel, applied to all by np.vectorize."""

import math

import numpy as np


def one(lm, v, white):
    bracket = 1.0 if math.isinf(white) else 1.0 + lm / (white * white)
    return min(lm * bracket / (1.0 + v), 1.0)


def display(Lm, adaptation, white=np.inf):
    return np.vectorize(one, otypes=[float])(Lm, adaptation, white)
