"""Puts the fields into a float32, whose exponent has another bias."""

import numpy as np


def decode_half(bits):
    b = bits.astype(np.uint32)
    sign, e, m = (b & 0x8000) << 16, (b >> 10) & 31, b & 1023
    exponent = np.where(e == 31, 255, e + 112).astype(np.uint32)
    word = sign | exponent << 23 | m << 13
    value = word.view(np.float32)
    small = np.float32(2.0**-24) * m.astype(np.float32)
    return np.where(e == 0, np.where(sign > 0, -small, small), value)
