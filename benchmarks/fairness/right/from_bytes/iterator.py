"""An iterator gives the header's bytes one at a time and so swallows one white byte per part; float64."""

import numpy as np


def from_bytes(data):
    stream = iter(bytes(data))

    def part():
        word = bytearray()
        for byte in stream:
            if bytes([byte]).isspace():
                if word:
                    return word.decode("ascii")
            else:
                word.append(byte)
        raise ValueError("the header ends too early")

    kind, width, height, number = part(), int(part()), int(part()), float(part())
    channels = {"PF": 3, "Pf": 1}[kind]
    order = np.dtype("f4").newbyteorder("<" if number < 0 else ">")
    values = np.frombuffer(bytes(stream), dtype=order, count=width * height * channels).astype(
        float
    )
    picture = np.flipud(values.reshape(height, width, channels))
    return picture if channels == 3 else picture[:, :, 0]
