"""One weight in the disc, another outside."""

import numpy as np


def centre(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    y, x = np.indices(shape) + 0.5
    d = np.hypot(y - at[0] * shape[0], x - at[1] * shape[1])
    disc = d <= np.quantile(d, share)
    return np.where(disc, inside / disc.sum(), (1 - inside) / (~disc).sum())
