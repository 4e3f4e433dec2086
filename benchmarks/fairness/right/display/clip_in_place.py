"""In place and with np.clip between 0 and 1; the input is left alone, its type kept."""

import numpy as np


def display(Lm, adaptation, white=np.inf):
    Lm = np.asarray(Lm)
    Ld = np.array(Lm, dtype=np.result_type(Lm, np.float32))
    Ld *= 1.0 / np.float64(white) ** 2
    Ld += 1
    Ld *= Lm
    Ld /= 1 + np.asarray(adaptation, dtype=Ld.dtype)
    return np.clip(Ld, 0, 1, out=Ld)
