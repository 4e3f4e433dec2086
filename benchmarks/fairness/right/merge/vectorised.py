"""All frames at once."""

import numpy as np


def merge(images, times, g, w=None):
    if w is None:
        w = np.minimum(np.arange(256), 255 - np.arange(256)) / 127
    lnt = np.log(times).reshape((-1,) + (1,) * (images.ndim - 1))
    gz = g[images] if g.ndim == 1 else np.stack([g[images[..., c], c] for c in range(3)], axis=-1)
    with np.errstate(invalid="ignore"):
        return np.exp((w[images] * (gz - lnt)).sum(axis=0) / w[images].sum(axis=0))
