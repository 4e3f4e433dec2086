import io

import numpy as np


def from_bytes(data):
    f = io.BytesIO(data)
    color = f.readline().rstrip() == b"PF"
    w, h = [int(x) for x in f.readline().split()]
    scale = float(f.readline())
    endian = "<" if scale < 0 else ">"
    img = np.frombuffer(f.read(), endian + "f4")
    shape = (h, w, 3) if color else (h, w)
    return np.flipud(img.reshape(shape))
