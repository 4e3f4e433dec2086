"""Rows as little endian bytes, joined in reversed order; the number is -1.000000; (H, W, 1) is gray."""

import numpy as np


def header(E):
    colour = E.ndim == 3 and E.shape[2] == 3
    return ("PF" if colour else "Pf") + "\n%d %d\n%f\n" % (E.shape[1], E.shape[0], -1)


def to_bytes(E):
    E = np.array(E, dtype="<f4")
    if E.ndim not in (2, 3) or E.ndim == 3 and E.shape[2] not in (1, 3):
        raise ValueError("radiance must be (H, W) or (H, W, 3)")
    return header(E).encode() + b"".join(row.tobytes() for row in reversed(E))
