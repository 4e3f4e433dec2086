"""The power of two, without its mantissa."""

import numpy as np


def decode_half(bits):
    b = bits.astype(int)
    return np.where(b >> 15, -1.0, 1.0) * 2.0 ** ((b >> 10 & 31) - 15)
