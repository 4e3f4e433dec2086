"""Each pixel searches its own width in plain Python; negative or undefined luminance counts as black."""

import math

import numpy as np
from scipy import ndimage


def search(values, constants, threshold):
    """The value at the largest width up to which all responses stay small."""
    found = values[0]
    for v1, v2, c in zip(values, values[1:], constants):
        if not abs((v1 - v2) / (c + v1)) < threshold:
            break
        found = v1
    return found


def tonemap(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    L = np.asarray(L, dtype=np.float64)
    if L.ndim != 2:
        raise ValueError("luminance must be (H, W)")
    if key == "auto" or min(key, phi, threshold) <= 0 or (white is not None and white <= 0):
        raise ValueError("knobs must be positive")
    L = np.where(np.isfinite(L), L, 0).clip(min=0)
    lit = np.sort(L[L > 0])
    if len(lit) == 0:
        return np.zeros(L.shape, dtype=np.float32)
    middle = (lit[(len(lit) - 1) // 2] + lit[len(lit) // 2]) / 2
    logarithms = [math.log(v + 1e-6 * middle) for v in L.ravel().tolist()]
    Lm = L * (key / math.exp(math.fsum(logarithms) / L.size))
    if white is None:
        keep = L.size - round(1e-4 * L.size)
        white = max(np.partition(Lm.ravel(), keep - 1)[keep - 1], 1.0)
    V = Lm
    if local:
        widths = [1.6**i for i in range(9)]
        pictures = [ndimage.gaussian_filter(Lm, s / 4, mode="mirror") for s in widths]
        constants = [2**phi * key / s**2 for s in widths[:-1]]
        pixels = np.stack(pictures, axis=-1).reshape(-1, 9).tolist()
        V = np.array([search(values, constants, threshold) for values in pixels]).reshape(L.shape)
    bracket = 1 + Lm / white**2
    return np.float32(np.where(Lm * bracket < 1 + V, Lm * bracket / (1 + V), 1.0))
