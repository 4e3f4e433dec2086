"""bytes.split cuts off three parts, the number is read up to its first white byte; fresh float32."""

import numpy as np


def from_bytes(data):
    kind, width, height, rest = bytes(data).split(None, 3)
    number = rest.split(None, 1)[0]
    order = "<" if float(number) < 0 else ">"
    shape = (int(height), int(width)) + ((3,) if kind == b"PF" else ())
    count = int(np.prod(shape))
    values = np.frombuffer(rest, dtype=order + "f4", count=count, offset=len(number) + 1)
    return values.reshape(shape)[::-1].astype(np.float32)
