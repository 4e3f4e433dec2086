import numpy as np


def decode_half(bits):
    b = np.asarray(bits).astype(np.int64)
    s = b >> 15
    e = (b >> 10) & 31
    m = b & 1023
    sign = np.where(s == 1, -1.0, 1.0)
    normal = sign * 2.0 ** (e - 15) * (1 + m / 1024)
    small = sign * 2.0**-14 * (m / 1024)
    special = np.where(m == 0, sign * np.inf, np.nan)
    return np.where(e == 31, special, np.where(e == 0, small, normal))
