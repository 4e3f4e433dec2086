"""np.ldexp of whole numbers; masks for the rest."""

import numpy as np


def decode_half(bits):
    bits = np.array(bits, dtype=np.int32)
    e = (bits & 0x7C00) >> 10
    m = bits & 0x03FF
    out = np.ldexp((m + 1024).astype(float), e - 25)
    out[e == 0] = np.ldexp(m[e == 0].astype(float), -24)
    out[(e == 31) & (m == 0)] = np.inf
    out[(e == 31) & (m != 0)] = np.nan
    out[bits & 0x8000 != 0] *= -1
    return out
