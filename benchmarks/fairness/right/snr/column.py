"""By the reciprocal, the noise over the signal, as a column."""

import numpy as np


def snr(g, *, least=0.01, span=4):
    f = np.exp(np.ravel(g))
    n = len(f)
    noise = np.array(
        [
            (f[min(z + span, n - 1)] - f[max(z - span, 0)])
            / (min(z + span, n - 1) - max(z - span, 0))
            for z in range(n)
        ]
    )
    noise = (
        np.where(
            noise < least * np.ptp(f[[0, -1]]) / (n - 1),
            least * np.ptp(f[[0, -1]]) / (n - 1),
            noise,
        )
        / f
    )
    w = 1 / noise
    w[:1] = w[-1:] = 0
    return w.reshape(-1, 1)
