"""You strip white space before the values; a value's own bytes may look like white space."""

import numpy as np


def from_bytes(data):
    kind, width, height, scale, rest = data.split(None, 4)
    shape = (int(height), int(width), 3) if kind == b"PF" else (int(height), int(width))
    values = np.frombuffer(rest[: 4 * int(np.prod(shape))], "<f4" if float(scale) < 0 else ">f4")
    return values.reshape(shape)[::-1]
