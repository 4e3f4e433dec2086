"""Lists of floats and math.fsum, bin after bin; an array only where it is yielded."""

import math

import numpy as np


def adjust_steps(h, db, D, *, tolerance=0.025):
    counts = [float(c) for c in h]
    total = start = math.fsum(counts)
    yield np.array(counts), math.inf, total, math.inf
    trimmings = math.inf
    while trimmings > 0 and trimmings >= tolerance * total:
        total = math.fsum(counts)
        ceiling = total * db / D
        trimmings = 0.0
        for i, c in enumerate(counts):
            if c > ceiling:
                trimmings += c - ceiling
                counts[i] = ceiling
        yield np.array(counts), ceiling, total, trimmings
        if math.fsum(counts) <= tolerance * start:
            break
