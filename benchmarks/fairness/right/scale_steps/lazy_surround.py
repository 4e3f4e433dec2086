"""Takes blurred pictures as they come (also from an iterator), keeps float32, and marks what was uneven."""

import numpy as np


def scale_steps(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    pictures = iter(blurred)
    V1 = np.asarray(next(pictures), np.float32)
    uneven = np.zeros_like(V1, dtype=bool)
    adaptation = V1
    for n, V2 in enumerate(pictures):
        V2 = np.asarray(V2, np.float32)
        s = np.power(1.6, n)
        V = np.divide(V1 - V2, np.float32(2**phi * key * s**-2) + V1)
        uneven = uneven | ~(np.absolute(V) < threshold)
        adaptation = np.select([uneven], [adaptation], V1)
        yield (s, V1, V, ~uneven, adaptation)
        V1 = V2
