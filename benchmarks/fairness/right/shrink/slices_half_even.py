"""Four strided slices as floats, np.rint: a half goes to the even number."""

import numpy as np


def shrink(Y):
    rows, columns = (n - n % 2 for n in Y.shape[:2])
    even = Y[:rows, :columns].astype(np.float64)
    mean = (even[::2, ::2] + even[1::2, ::2] + even[::2, 1::2] + even[1::2, 1::2]) / 4
    return np.rint(mean).astype(Y.dtype)
