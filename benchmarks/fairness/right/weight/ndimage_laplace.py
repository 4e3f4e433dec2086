"""scipy's Laplacian, np.std and a product of Gaussians."""

import numpy as np
from scipy.ndimage import laplace


def weight(F, powers=(1, 1, 1)):
    C = np.abs(laplace(np.tensordot([0.299, 0.587, 0.114], F, axes=1)))
    S = F.std(axis=0)
    E = np.exp(-((F - 0.5) ** 2) / 0.08).prod(axis=0)
    return C ** powers[0] * S ** powers[1] * E ** powers[2]
