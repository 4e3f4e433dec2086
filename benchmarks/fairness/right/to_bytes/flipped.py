"""Rows turned round, little endian."""

import numpy as np


def to_bytes(E):
    E = np.asarray(E)
    kind = "PF" if E.ndim == 3 else "Pf"
    return (
        f"{kind}\n{E.shape[1]} {E.shape[0]}\n-1.0\n".encode() + np.flipud(E).astype("<f4").tobytes()
    )
