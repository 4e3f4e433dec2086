"""f^-1 is read from a fine table of f."""

import numpy as np


def table(delta, *, a=1.79, c=0.192):
    def f(q):
        return 255 * np.exp(-c * np.log1p(np.exp(-a * q)))

    q = np.linspace(-40, 25, 400_001)
    out = np.rint(f(np.interp(np.arange(256), f(q), q) + delta)).astype(np.uint8)
    out[0], out[255] = 0, 255
    return out
