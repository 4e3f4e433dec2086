"""np.average with its weights; 0 where nothing is known."""

import numpy as np


def merge(images, times, g, w=None):
    if w is None:
        w = np.minimum(np.arange(256), 255 - np.arange(256)) / 127
    curves = np.reshape(g, (256, -1))
    Z = images.reshape(*images.shape[:3], -1)
    lE = np.stack([curves[Z[..., c], c % curves.shape[1]] for c in range(Z.shape[-1])], axis=-1)
    lE = lE - np.log(times)[:, None, None, None]
    W = w[Z]
    known = W.sum(axis=0) > 0
    E = np.where(known, np.exp(np.average(lE, axis=0, weights=np.where(known, W, 1))), 0)
    return E.reshape(images.shape[1:])
