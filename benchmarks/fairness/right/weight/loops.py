"""Pixel by pixel; the border takes the nearest pixel of the picture."""

import math

import numpy as np


def weight(F, powers=(1, 1, 1)):
    _, H, W = F.shape
    Y = 0.299 * F[0] + 0.587 * F[1] + 0.114 * F[2]
    out = np.zeros((H, W))
    for y in range(H):
        for x in range(W):
            r, g, b = (float(one) for one in F[:, y, x])
            near = (
                Y[max(y - 1, 0), x]
                + Y[min(y + 1, H - 1), x]
                + Y[y, max(x - 1, 0)]
                + Y[y, min(x + 1, W - 1)]
            )
            mean = (r + g + b) / 3
            C = abs(near - 4 * Y[y, x])
            S = math.sqrt(((r - mean) ** 2 + (g - mean) ** 2 + (b - mean) ** 2) / 3)
            E = math.prod(math.exp(-((v - 0.5) ** 2) / (2 * 0.2**2)) for v in (r, g, b))
            out[y, x] = C ** powers[0] * S ** powers[1] * E ** powers[2]
    return out
