"""Plain Python pixel after pixel, which stops caring for a pixel once it was uneven; yields lists."""

import numpy as np


def scale_steps(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    levels = [np.asarray(b, float).tolist() for b in blurred]
    H, W = len(levels[0]), len(levels[0][0])
    even = [[True] * W for _ in range(H)]
    adaptation = [row[:] for row in levels[0]]
    for i in range(len(levels) - 1):
        s = 1.6**i
        constant = 2.0**phi * key / s**2
        V = [[0.0] * W for _ in range(H)]
        for y in range(H):
            for x in range(W):
                v1, v2 = levels[i][y][x], levels[i + 1][y][x]
                V[y][x] = (v1 - v2) / (constant + v1)
                if even[y][x]:
                    if abs(V[y][x]) < threshold:
                        adaptation[y][x] = v1
                    else:
                        even[y][x] = False
        yield [s, np.array(levels[i]), np.array(V), np.array(even), np.array(adaptation)]
