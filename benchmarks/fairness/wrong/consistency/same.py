"""1 where the frames are the same."""

import numpy as np


def consistency(v, v_):
    return (np.abs(v - v_).max(axis=-1, keepdims=True) < 1e-4).astype(float)
