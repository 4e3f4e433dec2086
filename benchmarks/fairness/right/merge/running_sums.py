"""One photograph after the other into two float32 sums; undefined pixels become 0."""

import numpy as np


def hat():
    return 1 - np.abs(np.arange(256) / 127.5 - 1)


def merge(images, times, g, w=None):
    w = hat() if w is None else np.asarray(w)
    g = np.asarray(g)
    if np.ndim(images[0]) == 2:
        g = g.reshape(256)
    above = np.zeros(np.shape(images[0]), np.float32)
    below = np.zeros_like(above)
    for image, t in zip(images, times):
        image = np.asarray(image)
        weight = w[image].astype(np.float32)
        if g.ndim == 1:
            lnE = g[image] - np.log(t)
        else:
            lnE = np.stack([g[image[..., c], c] for c in range(g.shape[1])], axis=-1) - np.log(t)
        above += weight * lnE.astype(np.float32)
        below += weight
    E = np.zeros_like(above)
    known = below > 0
    E[known] = np.exp(above[known] / below[known])
    return E
