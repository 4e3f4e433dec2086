import numpy as np


def decode_half(bits):
    b = np.array(bits, dtype=np.uint16, order="C", copy=True)
    return b.view(np.float16).astype(np.float32)
