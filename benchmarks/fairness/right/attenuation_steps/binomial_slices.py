"""Blur 1 2 1, edges repeated (symmetric), every second pixel; enlarged by copying and averaging; float32."""

import numpy as np


def halve(l):
    for axis in (0, 1):
        p = np.pad(l, [(1, 1) if a == axis else (0, 0) for a in (0, 1)], mode="symmetric")
        n = l.shape[axis]
        l = sum(c * np.take(p, np.arange(i, i + n), axis) for i, c in enumerate((0.25, 0.5, 0.25)))
    return l[::2, ::2]


def double(small, n):
    """Twice the rows: the old ones at even places, means of two between them, n in all."""
    big = np.empty((2 * len(small), small.shape[1]), small.dtype)
    big[0::2] = small
    big[1:-1:2] = (small[:-1] + small[1:]) / 2
    big[-1] = small[-1]
    return big[:n]


def attenuation_steps(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    levels = [np.asarray(lL, np.float32)]
    while min(levels[-1].shape) > 62:
        levels.append(halve(levels[-1]).astype(np.float32))
    Phi = np.ones((1, 1), np.float32)
    for k, l in reversed(list(enumerate(levels))):
        p = np.pad(l, 1, mode="symmetric")
        slope = np.hypot(p[2:, 1:-1] - p[:-2, 1:-1], p[1:-1, 2:] - p[1:-1, :-2]) / 2 ** (k + 1)
        mean = slope.mean()
        relative = (
            np.maximum(slope, noise * mean) / mean if mean > 0 else np.full_like(slope, noise)
        )
        phi = (relative / alpha) ** (beta - 1)
        if k < len(levels) - 1:
            Phi = double(double(Phi, l.shape[0]).T, l.shape[1]).T * phi
        else:
            Phi = phi
        yield k, l, slope, phi, Phi
