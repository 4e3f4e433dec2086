"""A project in loops with Python's math module."""

# %%
import math

import numpy as np
from scipy.ndimage import gaussian_filter1d

# %% task="tonemap"


def tonemap(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    H, W = np.shape(L)
    values = [float(v) for v in np.ravel(L)]
    for v in [*values, key, phi, threshold, 1.0 if white is None else white]:
        if math.isnan(v):
            raise ValueError("NaN")
    if min(values) < 0 or max(values) == math.inf or min(key, threshold, white or 1.0) <= 0:
        raise ValueError("expected what is positive and finite")
    lit = sorted(v for v in values if v > 0)
    if not lit:
        return np.zeros((H, W))
    delta = 1e-6 * lit[len(lit) // 2]
    average = math.exp(math.fsum(math.log(delta + v) for v in values) / len(values))
    scaled = [key * v / average for v in values]
    if white is None:
        white = max(1.0, sorted(scaled)[math.ceil(0.9999 * len(scaled)) - 1])
    held = around(np.reshape(scaled, (H, W)), key, phi, threshold) if local else scaled
    shown = [
        min(1.0, v * (1 + v / white / white) / (1 + V)) for v, V in zip(scaled, held, strict=True)
    ]
    return np.reshape(shown, (H, W))


def around(Lm, key, phi, threshold):
    V1 = [gaussian_filter1d(gaussian_filter1d(Lm, 1.6**k / 4, 0), 1.6**k / 4, 1) for k in range(9)]
    for y, x in np.ndindex(Lm.shape):
        k = 0
        while k < 8 and abs(V1[k][y, x] - V1[k + 1][y, x]) < threshold * (
            2**phi * key / 1.6 ** (2 * k) + V1[k][y, x]
        ):
            k += 1
        yield V1[max(k - 1, 0)][y, x]
