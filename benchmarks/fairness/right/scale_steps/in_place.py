"""Float64, copies at every yield."""

import numpy as np


def scale_steps(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    V1 = np.array([np.asarray(one, float) for one in blurred])
    stopped, adaptation, s = np.zeros(V1.shape[1:], bool), V1[0].copy(), 1.0
    for centre, surround in zip(V1[:-1], V1[1:], strict=True):
        V = (centre - surround) / (2.0**phi * key / (s * s) + centre)
        stopped |= abs(V) >= threshold
        adaptation[~stopped] = centre[~stopped]
        yield s, centre.copy(), V, ~stopped, adaptation.copy()
        s *= 1.6
