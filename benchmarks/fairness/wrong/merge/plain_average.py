"""Wrong: the plain mean of the frames' own E, without weights and without logarithms."""

import numpy as np


def merge(images, times, g, w=None):
    images = np.asarray(images)
    g = np.asarray(g, float)
    gZ = g[images] if g.ndim == 1 else g[images, np.arange(g.shape[1])]
    t = np.reshape(times, (-1,) + (1,) * (images.ndim - 1))
    return np.mean(np.exp(gZ) / t, axis=0)
