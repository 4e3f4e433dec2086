"""math.log2 for one setting, spread over arrays by np.vectorize; numbers give a 0-d array."""

import math

import numpy as np


def _one(F, T, S):
    if not (F > 0 and T > 0 and S > 0):
        raise ValueError(f"settings must be positive, not F={F}, T={T}, S={S}")
    return 2 * math.log2(F) - math.log2(T) - math.log2(S / 100)


def ev(F, T, *, S=100.0):
    return np.vectorize(_one, otypes=[np.float64])(F, T, S)
