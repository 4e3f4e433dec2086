"""A function of one number, by numpy.vectorize."""

import math

import numpy as np


def signal(luminance):
    x = math.pow(luminance / 10000, 2610 / 16384)
    return math.pow((3424 + 32 * 2413 * x) / (4096 + 32 * 2392 * x), 128 * 2523 / 4096)


def pq(FD):
    return np.vectorize(signal, otypes=[float])(FD)
