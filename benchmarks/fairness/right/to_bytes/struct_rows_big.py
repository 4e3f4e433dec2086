"""Big endian, number 1.0, written row by row with struct from lists of floats."""

import struct

import numpy as np


def to_bytes(E):
    gray = np.ndim(E) == 2
    rows = np.asarray(E, dtype=np.float32)
    height, width = rows.shape[0], rows.shape[1]
    out = bytearray()
    out += b"Pf\n" if gray else b"PF\n"
    out += b"%d %d\n" % (width, height)
    out += b"1.0\n"
    for y in range(height - 1, -1, -1):
        values = rows[y].ravel().tolist()
        out += struct.pack(">%df" % len(values), *values)
    return bytes(out)
