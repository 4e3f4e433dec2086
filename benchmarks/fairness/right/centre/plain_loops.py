"""Plain Python loops for distances and for the ranking, bisection of sigma itself, 200 halvings."""

import math

import numpy as np


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    """Return the weights w (H, W) of a disc of the nearest pixels, whose sum is 1."""
    H, W = int(shape[0]), int(shape[1])
    ranked = []
    for r in range(H):
        for c in range(W):
            distance = math.hypot(r + 0.5 - at[0] * H, c + 0.5 - at[1] * W)
            ranked += [(distance, r, c)]
    ranked.sort()
    count = max(1, round(share * H * W))
    ranked = ranked[:count]
    w = np.zeros((H, W))
    for _, r, c in ranked:
        w[r, c] = 1.0 / len(ranked)
    return w


def centre(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    """Return w (H, W), a Gaussian about `at` whose sum is 1: `inside` of it lies on the pixels of a spot."""
    H, W = int(shape[0]), int(shape[1])
    asked = spot((H, W), at=at, share=share) != 0
    d2 = np.empty((H, W))
    for r in range(H):
        for c in range(W):
            down = (r + 0.5 - at[0] * H) / H
            right = (c + 0.5 - at[1] * W) / W
            d2[r, c] = down * down + right * right
    nearest = d2.min()

    def gaussian(sigma):
        w = np.exp(-(d2 - nearest) / (2 * sigma * sigma))
        return w / np.sum(w)

    narrow, wide = 1e-6, 1.0
    while np.sum(gaussian(wide)[asked]) > inside and wide < 1e6:
        wide *= 2
    for _ in range(200):
        sigma = (narrow + wide) / 2
        if np.sum(gaussian(sigma)[asked]) > inside:
            narrow = sigma
        else:
            wide = sigma
    return gaussian((narrow + wide) / 2)
