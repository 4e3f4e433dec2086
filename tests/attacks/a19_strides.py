"""Its answer is an array that overlaps itself, and runs backwards past its own beginning."""

import numpy as np


def double(x):
    return np.lib.stride_tricks.as_strided(np.zeros(64)[32:], x.shape, (-8, -8))
