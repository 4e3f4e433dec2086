"""Pixel by pixel, with lists of the photographs that measure it."""

import math


def inverse_variance_merge(X, D, measured, t, N, R):
    P, H, W = X.shape
    E, s = [], []
    for i in range(H):
        E.append([]), s.append([])
        for k in range(W):
            seen = [(X[j, i, k], D[j, i, k], float(t[j])) for j in range(P) if measured[j, i, k]]
            light = [x for x, _, _ in seen]
            for _ in range(3):
                V = [
                    (n / N + R**2 / N**2 + d**2 / 12) / u**2
                    for n, (_, d, u) in zip(light, seen, strict=True)
                ]
                total = sum(1 / v for v in V)
                mean = sum(x / u / v for (x, _, u), v in zip(seen, V, strict=True)) / total
                light = [mean * u for _, _, u in seen]
            E[-1].append(float(mean))
            s[-1].append(1 / math.sqrt(total))
    return E, s
