"""The mean of the estimates in each 3 x 3 pixels."""

import numpy as np
from scipy.ndimage import uniform_filter


def reconstruct(Z, e, c=None, *, sigma=0.5, full_well=np.inf, read_noise=0.0):
    E = uniform_filter(Z / 255 / e, 3)
    return E if c is None else np.stack([E, E, E], axis=-1)
