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
                step = sigma * math.pow(d / sigma, alpha)
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
