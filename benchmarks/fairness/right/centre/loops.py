"""Lists and loops; the width by secants."""

import math

import numpy as np


def centre(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    H, W = shape
    places = []
    for i in range(H):
        for j in range(W):
            v, u = (i + 0.5) / H - at[0], (j + 0.5) / W - at[1]
            places.append((math.hypot(v * H, u * W), v * v + u * u, i, j))
    places.sort()
    count = max(1, round(share * H * W))

    def part(precision):
        each = [math.exp(-precision * d2) for _, d2, _, _ in places]
        return sum(each[:count]) / sum(each)

    low, high = 1e-6, 1e4
    for _ in range(60):
        middle = math.sqrt(low * high)
        if part(middle) < inside:
            low = middle
        else:
            high = middle
    w = np.zeros((H, W))
    for _, d2, i, j in places:
        w[i, j] = math.exp(-low * d2)
    return w / w.sum()
