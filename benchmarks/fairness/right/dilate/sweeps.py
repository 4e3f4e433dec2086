"""Exact distance in two passes over rows and columns; outside grows by steps until nothing changes; int."""

import numpy as np


def dilate(mask, margin):
    mask = np.asarray(mask, bool)
    H, W = mask.shape
    far = 10 * (H + W + margin)
    up = np.full((H, W), far)
    near = np.full(W, far)
    for y in range(H):
        near = np.where(mask[y], 0, near + 1)
        up[y] = near
    near = np.full(W, far)
    for y in range(H - 1, -1, -1):
        near = np.where(mask[y], 0, near + 1)
        up[y] = np.minimum(up[y], near)
    wide = np.zeros((H, W), bool)
    for dx in range(-min(margin, W - 1), min(margin, W - 1) + 1):
        reach = up**2 <= margin**2 - dx**2
        if dx >= 0:
            wide[:, dx:] |= reach[:, : W - dx]
        else:
            wide[:, :dx] |= reach[:, -dx:]
    rest = ~wide
    out = np.zeros((H, W), bool)
    out[0], out[-1] = rest[0], rest[-1]
    out[:, 0], out[:, -1] = rest[:, 0], rest[:, -1]
    count = -1
    while out.sum() != count:
        count = out.sum()
        more = out.copy()
        more[1:] |= out[:-1]
        more[:-1] |= out[1:]
        more[:, 1:] |= out[:, :-1]
        more[:, :-1] |= out[:, 1:]
        out = more & rest
    return (~out).astype(int)
