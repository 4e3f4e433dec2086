"""Lists of states, masks as 0 and 1."""

import numpy as np


def scale_steps(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    V1, states = [np.asarray(one, np.float32) for one in blurred], []
    run = 0
    for k, s in enumerate(1.6 ** np.arange(len(V1) - 1)):
        V = (V1[k] - V1[k + 1]) / (np.float32(2**phi * key / s**2) + V1[k])
        run = run + (np.abs(V) < threshold) * (run == k)
        adaptation = np.choose(np.maximum(run - 1, 0), V1[: k + 1])
        states.append([float(s), V1[k], V, (run == k + 1).astype(int), adaptation])
    return states
