"""The first place where H_B reaches the rank (lower end of a level stretch), in exact integers."""

import numpy as np


def brightness_transfer(h_A, h_B):
    a, b = [int(x) for x in h_A], [int(x) for x in h_B]
    n, sa, sb = len(a), sum(a), sum(b)
    H = [0]
    for x in b:
        H.append(H[-1] + x)
    T = np.full(n, np.nan)
    below = 0
    for m in range(n):
        rank = (2 * below + a[m]) * sb
        below += a[m]
        z = next(k for k in range(n + 1) if 2 * sa * H[k] >= rank)
        if z == 0:
            place = -0.5
        else:
            place = z - 1.5 + (rank - 2 * sa * H[z - 1]) / (2 * sa * (H[z] - H[z - 1]))
        if 0.5 <= place <= n - 1.5:
            T[m] = place
    return T
