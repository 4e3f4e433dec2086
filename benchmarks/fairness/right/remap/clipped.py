"""What lies within sigma, by clipping, and what is left over, each with its own rule."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    d = lL - g
    inside = np.clip(d, -sigma, sigma)
    outside = d - inside
    return g + np.sign(inside) * sigma * np.abs(inside / sigma) ** alpha + beta * outside
