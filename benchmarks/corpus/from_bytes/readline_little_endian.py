import numpy as np


def from_bytes(data):
    magic, size, scale, body = data.split(b"\n", 3)
    w, h = map(int, size.split())
    img = np.frombuffer(body, dtype="<f4")
    if magic == b"PF":
        return img.reshape(h, w, 3)[::-1]
    return img.reshape(h, w)[::-1]
