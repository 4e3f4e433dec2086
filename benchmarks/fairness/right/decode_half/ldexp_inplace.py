import numpy as np


def decode_half(bits):
    b = np.asarray(bits).astype(np.int32)
    e = (b & 0x7C00) >> 10
    m = b & 0x03FF
    mant = np.where(e > 0, m + 1024, m).astype(np.float64)
    out = np.asarray(np.ldexp(mant, np.maximum(e, 1) - 25))
    out = np.where((e == 31) & (m == 0), np.inf, out)
    out = np.where((e == 31) & (m != 0), np.nan, out)
    return np.copysign(out, np.where(b & 0x8000, -1.0, 1.0))
