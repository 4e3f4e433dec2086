import numpy as np


def to_bytes(E):
    E = np.asarray(E)
    magic = b"PF\n" if E.ndim == 3 else b"Pf\n"
    header = magic + f"{E.shape[1]} {E.shape[0]}\n-1.0\n".encode()
    return header + E.astype("<f4").tobytes()
