"""scipy's Laplacian."""

import numpy as np
from scipy.ndimage import laplace


def focus(block, noise=20.0):
    x = np.abs(laplace(block.astype(float), mode="nearest"))
    x[x <= noise] = 0
    return x.mean()
