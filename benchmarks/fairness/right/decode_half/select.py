"""np.select, and the power by exp2."""

import numpy as np


def decode_half(bits):
    sign = np.where(bits & 0x8000, -1.0, 1.0)
    e = np.bitwise_and(np.right_shift(bits, 10), 31).astype(np.float64)
    m = np.bitwise_and(bits, 1023) / 1024
    cases = [e == 0, (e == 31) & (m == 0), e == 31]
    return sign * np.select(cases, [np.exp2(-14) * m, np.inf, np.nan], np.exp2(e - 15) * (1 + m))
