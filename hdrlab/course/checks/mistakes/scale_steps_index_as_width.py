"""s is the width in pixels, 1, 1.6, 2.56 ... 26.8. You used the number of the step."""

import numpy as np

WIDTHS = 1.6 ** np.arange(9)


def scale_steps(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    even, adaptation = np.ones(blurred[0].shape, bool), blurred[0]
    for i in range(8):
        V1, V2 = blurred[i], blurred[i + 1]
        V = (V1 - V2) / (2**phi * key / (i + 1) ** 2 + V1)
        even = even & (np.abs(V) < threshold)
        adaptation = np.where(even, V1, adaptation)
        yield WIDTHS[i], V1, V, even, adaptation
