"""A loop over pixels with if and else and math.pow; the result is a list of lists."""

import math

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    lL = np.asarray(lL, dtype=float)
    places = np.broadcast_to(g, lL.shape)
    r = []
    for row, place in zip(lL.tolist(), places.tolist()):
        out = []
        for l, c in zip(row, place):
            d = abs(l - c)
            if d <= sigma:
                f = math.pow(d / sigma, alpha)
                if alpha < 1 and d < 0.02:
                    y = max(0.0, (d - 0.01) / 0.01)
                    tau = y * y * (2 - y) * (2 - y)
                    f = tau * f + (1 - tau) * d / sigma
                step = sigma * f
            else:
                step = sigma + beta * (d - sigma)
            if l > c:
                out.append(c + step)
            elif l < c:
                out.append(c - step)
            else:
                out.append(c)
        r.append(out)
    return r
