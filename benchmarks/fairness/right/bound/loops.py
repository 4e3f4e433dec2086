"""Pixel by pixel, lists."""

import math


def bound(Z, B, g, top, shown):
    E, flags = [], []
    for i in range(Z.shape[1]):
        low = [g[top] - B[j] for j in range(len(B)) if shown[j, i] and Z[j, i] >= top]
        high = [g[1] - B[j] for j in range(len(B)) if shown[j, i] and Z[j, i] == 0]
        ends = ([max(low)] if low else []) + ([min(high)] if high else [])
        E.append(math.exp(sum(ends) / len(ends)) if ends else 0.0)
        flags.append((1 if low else 0) + (2 if high else 0) or 8)
    return E, flags
