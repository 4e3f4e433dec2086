"""The values are the last bytes; split for the rest."""

import numpy as np


def from_bytes(data):
    kind, W, H, scale = data[:200].split(None, 4)[:4]
    shape = (int(H), int(W), 3) if kind == b"PF" else (int(H), int(W))
    E = np.frombuffer(data[len(data) - 4 * int(np.prod(shape)) :], np.dtype(np.float32))
    if float(scale) > 0:
        E = E.byteswap()
    return E.reshape(shape)[::-1].copy()
