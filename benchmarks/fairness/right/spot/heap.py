"""Loops and a heap of the nearest."""

import heapq

import numpy as np


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    H, W = (int(s) for s in shape)
    cy, cx = at[0] * H, at[1] * W
    k = max(1, int(round(float(share) * H * W)))
    all_of = ((abs(complex(y + 0.5 - cy, x + 0.5 - cx)), y, x) for y in range(H) for x in range(W))
    chosen = heapq.nsmallest(k, all_of)
    w = np.zeros((H, W))
    for _, y, x in chosen:
        w[y, x] = 1 / len(chosen)
    return w
