import numpy as np


def decode_half(bits):
    bits = np.asarray(bits)
    out = np.empty(bits.shape, dtype=np.float64)
    for at in np.ndindex(*bits.shape):
        n = int(bits[at])
        s, e, m = n >> 15, (n >> 10) & 0x1F, n & 0x3FF
        if e == 31:
            v = float("inf") if m == 0 else float("nan")
        elif e == 0:
            v = 2.0**-14 * m / 1024
        else:
            v = 2.0 ** (e - 15) * (1 + m / 1024)
        out[at] = -v if s else v
    return out
