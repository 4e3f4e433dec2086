"""Column by column, and no level below 8 pixels."""

import numpy as np

NEAR = [(0, 0)] + [(dy, dx) for dx in (-1, 0, 1) for dy in (-1, 0, 1) if dy or dx]


def halve(Y):
    Y = Y[: len(Y) // 2 * 2, : Y.shape[1] // 2 * 2].astype(float)
    return np.floor((Y[::2, ::2] + Y[1::2, ::2] + Y[::2, 1::2] + Y[1::2, 1::2]) / 4 + 0.5).astype(
        int
    )


def overlap(A, B, y, x):
    H, W = A.shape
    rows, columns = slice(max(y, 0), max(H + min(y, 0), 0)), slice(max(x, 0), max(W + min(x, 0), 0))
    of_b = slice(max(-y, 0), max(H - max(y, 0), 0)), slice(max(-x, 0), max(W - max(x, 0), 0))
    return A[rows, columns], B[of_b]


def pair(A, B, bits):
    pyramid = [(A.astype(int), B.astype(int))]
    while len(pyramid) < bits and min(pyramid[-1][0].shape) >= 16:
        pyramid.append((halve(pyramid[-1][0]), halve(pyramid[-1][1])))
    at = (0, 0)
    for a, b in pyramid[::-1]:
        ta, tb = (
            np.searchsorted(np.cumsum(np.bincount(Y.ravel(), minlength=256)), Y.size / 2)
            for Y in (a, b)
        )
        best, at = None, (2 * at[0], 2 * at[1])
        start = at
        for dy, dx in NEAR:
            y, x = start[0] + dy, start[1] + dx
            bits_a, bits_b = overlap(a > ta, b > tb, y, x)
            kept_a, kept_b = overlap(abs(a - ta) > 4, abs(b - tb) > 4, y, x)
            kept = kept_a & kept_b
            count = ((bits_a ^ bits_b) & kept).sum() / max(kept.sum(), 1)
            if best is None or count < best:
                best, at = count, (y, x)
    return np.array(at)


def align(images, *, bits=6, luma=False):
    grays = [image[..., 1] if image.ndim == 3 else image for image in images]
    order = np.argsort([Y.mean() for Y in grays], kind="stable")
    offsets = np.zeros((len(grays), 2), int)
    for before, k in zip(order[:-1], order[1:], strict=True):
        offsets[k] = offsets[before] + pair(grays[before], grays[k], bits)
    return offsets - offsets[order[len(order) // 2]]
