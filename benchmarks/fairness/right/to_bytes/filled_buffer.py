"""One buffer of the right length, header and picture put in their places; number -1."""

import numpy as np


def to_bytes(E):
    E = np.asarray(E, dtype=np.float64)
    text = ("Pf", "PF")[E.ndim - 2] + "\n" + str(E.shape[1]) + " " + str(E.shape[0]) + "\n-1\n"
    start = len(text)
    buffer = np.empty(start + 4 * E.size, dtype=np.uint8)
    buffer[:start] = np.frombuffer(text.encode(), dtype=np.uint8)
    picture = np.empty(E.shape, dtype="<f4")
    for y in range(E.shape[0]):
        picture[E.shape[0] - 1 - y] = E[y]
    buffer[start:] = picture.view(np.uint8).ravel()
    return buffer.tobytes()
