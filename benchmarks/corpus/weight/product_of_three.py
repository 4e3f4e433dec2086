import numpy as np


def weight(F, powers=(1, 1, 1)):
    r, g, b = F
    gray = 0.299 * r + 0.587 * g + 0.114 * b
    p = np.pad(gray, 1, mode="edge")
    lap = p[:-2, 1:-1] + p[2:, 1:-1] + p[1:-1, :-2] + p[1:-1, 2:] - 4 * gray
    C = np.abs(lap)
    S = np.std(F, axis=0)
    E = np.prod(np.exp(-((F - 0.5) ** 2) / (2 * 0.2**2)), axis=0)
    return C ** powers[0] * S ** powers[1] * E ** powers[2]
