"""A table of all 65536 values, by loops."""

import math

import numpy as np


def value(word):
    sign = -1.0 if word // 32768 else 1.0
    e, m = word // 1024 % 32, word % 1024
    if e == 31:
        return sign * math.inf if m == 0 else math.nan
    if e == 0:
        return sign * math.ldexp(m, -24)
    return sign * math.ldexp(1024 + m, e - 25)


def decode_half(bits):
    table = np.array([value(word) for word in range(65536)], np.float32)
    return table[bits]
