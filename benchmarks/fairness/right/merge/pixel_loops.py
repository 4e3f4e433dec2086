"""Plain Python over every value, with lists of floats; where nothing has weight E is 0."""

import math

import numpy as np


def merge(images, times, g, w=None):
    images = np.asarray(images)
    frames, shape = images.shape[0], images.shape[1:]
    channels = shape[2] if len(shape) == 3 else 1
    if w is None:
        w = [min(z, 255 - z) for z in range(256)]
    w = [float(v) for v in w]
    g = np.asarray(g, float)
    if g.ndim == 1:
        curves = [g.tolist()] * channels
    else:
        curves = [g[:, c].tolist() for c in range(g.shape[1])]
    ln_t = [math.log(t) for t in times]
    columns = images.reshape(frames, -1).T.tolist()
    result = []
    for i, levels in enumerate(columns):
        curve = curves[i % channels]
        above = below = 0.0
        for z, b in zip(levels, ln_t):
            above += w[z] * (curve[z] - b)
            below += w[z]
        result.append(math.exp(above / below) if below > 0 else 0.0)
    return np.array(result).reshape(shape)
