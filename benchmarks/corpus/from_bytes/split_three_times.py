import re

import numpy as np


def from_bytes(data):
    head = re.match(rb"(P[Ff])\s+(\d+)\s+(\d+)\s+(\S+)\s", data)
    w, h = int(head[2]), int(head[3])
    order = "<" if float(head[4]) < 0 else ">"
    channels = 3 if head[1] == b"PF" else 1
    values = np.frombuffer(data[head.end() :], order + "f4", w * h * channels)
    img = values.reshape(h, w, channels)[::-1]
    return img if channels == 3 else img[..., 0]
