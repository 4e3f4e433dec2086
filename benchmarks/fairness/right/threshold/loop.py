"""Counting in a loop; a list for several."""

import numpy as np


def threshold(h, q):
    if np.ndim(q):
        return [threshold(h, one) for one in q]
    need, seen = q * sum(h), 0
    for code in range(256):
        seen += h[code]
        if seen >= need:
            return code
