import numpy as np


def merge(images, times, g, w=None):
    z = np.arange(256)
    if w is None:
        w = np.where(z < 128, z, 255 - z)
    hdr = 0.0
    total = 0.0
    for k in range(len(images)):
        Z = images[k]
        if np.ndim(g) == 2:
            G = np.dstack([g[Z[:, :, c], c] for c in range(3)])
        else:
            G = g[Z]
        hdr = hdr + w[Z] * np.exp(G) / times[k]
        total = total + w[Z]
    return hdr / np.maximum(total, 1e-9)
