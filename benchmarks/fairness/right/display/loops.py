"""Pixel by pixel."""

import numpy as np


def display(Lm, adaptation, white=np.inf):
    out = np.empty(Lm.shape, np.float32)
    for at in np.ndindex(Lm.shape):
        v = float(Lm[at])
        out[at] = min(1.0, v * (1 + v / white / white) / (1 + float(adaptation[at])))
    return out
