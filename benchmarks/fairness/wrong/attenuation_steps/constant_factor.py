"""Wrong: one constant factor at all pixels of all levels, whatever their slope is."""

import numpy as np


def attenuation_steps(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    levels = [np.asarray(lL, dtype=float)]
    while (min(levels[-1].shape) + 1) // 2 >= 32:
        p = np.pad(levels[-1], 1, mode="edge")
        H, W = levels[-1].shape
        levels.append(
            sum(p[y : y + H, x : x + W] for y in range(3) for x in range(3))[::2, ::2] / 9
        )
    factor = (1 / alpha) ** (beta - 1)
    for k in range(len(levels) - 1, -1, -1):
        gy, gx = np.gradient(levels[k])
        slope = np.hypot(gy, gx) / 2**k
        phi = np.full(slope.shape, factor)
        yield k, levels[k], slope, phi, phi ** (len(levels) - k)
