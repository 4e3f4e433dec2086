import numpy as np


def to_pixels(E):
    out = np.zeros((*E.shape[:2], 4), np.uint8)
    for y in range(E.shape[0]):
        for x in range(E.shape[1]):
            m = float(E[y, x].max())
            if m <= 0:
                continue
            e = int(np.ceil(np.log2(m)))
            for c in range(3):
                out[y, x, c] = int(E[y, x, c] * 256 / 2.0**e) % 256
            out[y, x, 3] = e + 128
    return out
