import numpy as np
from scipy.ndimage import laplace


def weight(F, powers=(1, 1, 1)):
    gray = 0.299 * F[0] + 0.587 * F[1] + 0.114 * F[2]
    C = laplace(gray)
    S = np.std(F, axis=0)
    E = np.exp(-((F.mean(axis=0) - 0.5) ** 2) / (2 * 0.2**2))
    return C ** powers[0] * S ** powers[1] * E ** powers[2]
