import numpy as np
from scipy.ndimage import convolve


def weight(F, powers=(1, 1, 1)):
    wc, ws, we = powers
    Y = 0.299 * F[0] + 0.587 * F[1] + 0.114 * F[2]
    contrast = np.abs(convolve(Y, np.array([[0, 1, 0], [1, -4, 1], [0, 1, 0]])))
    saturation = F.std(axis=0)
    exposed = np.exp(-((F - 0.5) ** 2) / (2 * 0.04)).prod(axis=0)
    return contrast**wc + saturation**ws + exposed**we
