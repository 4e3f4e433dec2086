"""A project in float32, with the white point from a partial sort."""

# %% task="tonemap"
import numpy as np
from scipy.ndimage import gaussian_filter

f32 = np.float32


def tonemap(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    L = np.asarray(L)
    if not (np.isfinite(L).all() and (L >= 0).all() and key > 0 and threshold > 0):
        raise ValueError("no luminance, or no knob")
    if white is not None and not white > 0:
        raise ValueError("no white")
    scale = f32(L.max()) or f32(1)
    lit = L[L > 0] / float(scale)
    if not lit.size:
        return np.zeros(L.shape, f32)
    least = 1e-6 * np.median(lit)
    lL = np.log(np.maximum(L / float(scale), 0) + least)
    Lm = (key * (L / float(scale)) / np.exp(lL.mean())).astype(f32)
    if white is None:
        k = int(0.9999 * (Lm.size - 1))
        white = max(1.0, float(np.partition(Lm.ravel(), k)[k]))
    V = adapted(Lm, key, phi, threshold) if local else Lm
    return np.clip(Lm * (1 + Lm / f32(white) ** 2) / (1 + V), 0, 1)


def adapted(Lm, key, phi, threshold):
    blurred = [gaussian_filter(Lm, 1.6**k / 4) for k in range(9)]
    V, even = blurred[0], np.ones(Lm.shape, bool)
    for k in range(8):
        a = 2**phi * key / (1.6**k) ** 2
        even &= np.abs((blurred[k] - blurred[k + 1]) / (a + blurred[k])) < threshold
        V = np.where(even, blurred[k], V)
    return V
