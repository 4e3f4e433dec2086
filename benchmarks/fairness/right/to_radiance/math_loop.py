"""Python integers, pixel by pixel, with math.ldexp."""

import math

import numpy as np


def decode(r, g, b, e):
    if e == 0:
        return [0.0, 0.0, 0.0]
    return [math.ldexp(m / 256, e - 128) for m in (r, g, b)]


def to_radiance(pixels):
    return np.array([[decode(*p) for p in row] for row in np.asarray(pixels).tolist()], dtype=float)
