"""ln L from black to white."""

import numpy as np


def equalise(L, *, bins=1024, limit=4.0):
    b = np.log(L)
    return (b - b.min()) / (b.max() - b.min())
