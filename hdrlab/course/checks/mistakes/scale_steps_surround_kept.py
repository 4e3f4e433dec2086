"""You never update the surround: at each width the centre is compared with the next larger blur, not with
the same one."""

import numpy as np

WIDTHS = 1.6 ** np.arange(9)


def scale_steps(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    even, adaptation = np.ones(blurred[0].shape, bool), blurred[0]
    V2 = blurred[1]
    for i in range(8):
        V1 = blurred[i]
        V = (V1 - V2) / (2**phi * key / WIDTHS[i] ** 2 + V1)
        even = even & (np.abs(V) < threshold)
        adaptation = np.where(even, V1, adaptation)
        yield WIDTHS[i], V1, V, even, adaptation
