"""One logarithm, float32."""

import numpy as np


def ev(F, T, *, S=100.0):
    F, T, S = np.float32(F), np.asarray(T, np.float32), np.float32(S)
    return np.log2(100 * F * F / (T * S))
