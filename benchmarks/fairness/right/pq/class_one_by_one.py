"""A class holds the constants as decimals and codes one luminance at a time, in a loop over the array."""

import numpy as np


def pq(FD):
    class Quantiser:
        m1, m2 = 0.1593017578125, 78.84375
        c1, c2, c3 = 0.8359375, 18.8515625, 18.6875
        peak = 10_000.0

        def __call__(self, luminance):
            y = (luminance / self.peak) ** self.m1
            return ((self.c1 + self.c2 * y) / (1.0 + self.c3 * y)) ** self.m2

    code = Quantiser()
    FD = np.asarray(FD, dtype=float)
    v = np.empty(FD.shape)
    for k in range(FD.size):
        v.flat[k] = code(float(FD.flat[k]))
    return v
