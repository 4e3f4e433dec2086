"""The formula in one line, at most 1 by np.minimum."""

import numpy as np


def display(Lm, adaptation, white=np.inf):
    Lm, adaptation = np.asarray(Lm), np.asarray(adaptation)
    return np.minimum(Lm * (1 + Lm / np.square(float(white))) / (1 + adaptation), 1)
