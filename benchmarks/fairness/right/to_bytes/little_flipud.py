"""Little endian by dtype, number -1.0, rows turned by np.flipud."""

import numpy as np


def to_bytes(E):
    E = np.asarray(E)
    kind = "PF" if E.ndim == 3 else "Pf"
    height, width = E.shape[:2]
    header = f"{kind}\n{width} {height}\n-1.0\n"
    return header.encode("ascii") + np.flipud(E).astype("<f4").tobytes()
