import numpy as np


def to_bytes(E):
    E = np.asarray(E, np.float32)
    out = bytearray()
    out += b"PF\n" if E.ndim == 3 else b"Pf\n"
    out += ("%d %d\n" % E.shape[:2]).encode()
    out += b"-1.0\n"
    out += E.tobytes()
    return bytes(out)
