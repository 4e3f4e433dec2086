"""The ends are repeated, and the counts of steps are found in the same way."""

import numpy as np


def snr(g, *, least=0.01, span=4):
    f, z = np.exp(g - np.max(g)), np.arange(len(g))
    rise, run = (np.pad(v, span, mode="edge") for v in (f, z))
    slope = (rise[2 * span :] - rise[: -2 * span]) / (run[2 * span :] - run[: -2 * span])
    slope = slope / slope_of_chord(f)
    w = np.zeros(len(f))
    w[1:-1] = f[1:-1] / np.clip(slope[1:-1], least, None)
    return w


def slope_of_chord(f):
    return (f[-1] - f[0]) / (len(f) - 1)
