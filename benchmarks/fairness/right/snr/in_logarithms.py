"""ln w = g - ln f', and the ends are set to 0 at last."""

import numpy as np


def snr(g, *, least=0.01, span=4):
    g = np.asarray(g)
    g = g - g[-1]
    top = len(g) - 1
    slope = []
    for z in range(len(g)):
        near = np.exp(g[[max(z - span, 0), min(z + span, top)]])
        slope.append(np.diff(near)[0] / (min(z + span, top) - max(z - span, 0)))
    floor = least * (1 - np.exp(g[0])) / top
    w = np.exp(g - np.log(np.maximum(slope, floor)))
    return np.concatenate([[0], w[1:-1], [0]])
