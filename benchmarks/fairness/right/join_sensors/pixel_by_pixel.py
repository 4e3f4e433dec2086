"""Loops over padded arrays, sums in lists."""

import numpy as np


def join_sensors(B, D, full):
    b, d, f = (np.pad(a, 2, mode="edge") for a in (B, D, full))
    E, case = [], []
    for i in range(B.shape[0]):
        E.append([])
        case.append([])
        for j in range(B.shape[1]):
            window = np.s_[i : i + 5, j : j + 5]
            n, ok = int(f[window].sum()), ~f[window]
            u = n / 25
            if not full[i, j]:
                c, e = (1, B[i, j]) if n == 0 else (2, (1 - u) * B[i, j] + u * D[i, j])
            elif n == 25:
                c, e = 4, D[i, j]
            else:
                P = D[i, j] * b[window][ok].sum() / d[window][ok].sum()
                c, e = 3, (1 - u) * P + u * D[i, j]
            E[-1].append(float(e))
            case[-1].append(c)
    return E, case
