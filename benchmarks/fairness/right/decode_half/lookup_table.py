import numpy as np


def _value(code):
    sign = -1.0 if code // 32768 else 1.0
    e = (code % 32768) // 1024
    m = code % 1024
    if e == 31:
        return sign * np.inf if m == 0 else np.nan
    if e == 0:
        return sign * m * 2.0**-24
    return sign * (1024 + m) * 2.0 ** (e - 25)


_TABLE = np.array([_value(c) for c in range(65536)], dtype=np.float32)


def decode_half(bits):
    return _TABLE[np.asarray(bits, dtype=np.uint16)]
