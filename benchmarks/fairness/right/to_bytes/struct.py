"""Value by value."""

import struct


def to_bytes(E):
    H, W = E.shape[:2]
    out = (("PF" if E.ndim == 3 else "Pf") + "\n" + str(W) + " " + str(H) + "\n-1\n").encode(
        "ascii"
    )
    for y in range(H - 1, -1, -1):
        row = [float(v) for v in E[y].reshape(-1)]
        out += struct.pack("<" + str(len(row)) + "f", *row)
    return out
