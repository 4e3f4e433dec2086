"""B is the natural logarithm of the times; you took the one to the base 2, and every stop is 1.44 times
too long."""

import numpy as np

from hdrlab.response import debevec


def gsolve(Z, B, smoothness, w):
    return debevec.gsolve(Z, B / np.log(2), smoothness, w)
