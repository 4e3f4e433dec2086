"""Parts of homework 4 as helpers (a generator of states, its last one taken); white is one of the values."""

import numpy as np
from scipy import ndimage, stats


def scale_steps(blurred, key, phi, threshold):
    even, adaptation = True, blurred[0]
    for n, (V1, V2) in enumerate(zip(blurred[:-1], blurred[1:])):
        s = 1.6**n
        V = (V1 - V2) / (2**phi * key / s**2 + V1)
        even = (abs(V) < threshold) & even
        adaptation = np.where(even, V1, adaptation)
        yield s, V1, V, even, adaptation


def display(Lm, adaptation, white):
    return np.minimum(Lm * (1 + Lm / white**2) / (1 + adaptation), 1)


def tonemap(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    L = np.asarray(L, dtype=float)
    knobs = [key, phi, threshold] if white is None else [key, phi, threshold, white]
    if any(isinstance(k, str) or not k > 0 for k in knobs):
        raise ValueError("a knob is not positive")
    if L.ndim != 2 or not (np.isfinite(L) & (L >= 0)).all():
        raise ValueError("luminance is not (H, W), finite and positive or zero")
    if L.max() == 0:
        return L.astype(np.float32)
    Lm = key * L / stats.gmean(L + 1e-6 * np.median(L[L != 0]), axis=None)
    if white is None:
        white = np.maximum(np.quantile(Lm, 1 - 1e-4, method="lower"), 1)
    if not local:
        return display(Lm, Lm, white).astype(np.float32)
    sigmas = 1.6 ** np.arange(9) / 4
    blurred = [ndimage.gaussian_filter(Lm, sigma, mode="nearest", truncate=6) for sigma in sigmas]
    *_, last = scale_steps(blurred, key, phi, threshold)
    return display(Lm, last[-1], white).astype(np.float32)
