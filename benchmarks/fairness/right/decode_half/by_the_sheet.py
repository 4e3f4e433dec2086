"""As the sheet says."""

import numpy as np


def decode_half(bits):
    b = np.asarray(bits).astype(int)
    s, e, m = b >> 15, (b >> 10) & 31, b & 1023
    normal = 2.0 ** (e - 15) * (1 + m / 1024)
    small = 2.0**-14 * m / 1024
    special = np.where(m == 0, np.inf, np.nan)
    value = np.where(e == 0, small, np.where(e == 31, special, normal))
    return np.where(s == 1, -value, value)
