"""In float32, answered as an array of one number; the dark pair is left out, since its S is 0."""

import numpy as np


def line(S, V):
    s, v = np.float32(S)[1:], np.float32(V)
    x, y = s / v[1:], (v[1:] - v[0]) / v[1:]
    return np.array([x @ y / (x @ x)])
