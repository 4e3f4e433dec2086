"""Step by step as the sheet has it, float64 until the end, scipy's Gaussian and np.quantile as they come."""

import numpy as np
from scipy.ndimage import gaussian_filter


def tonemap(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    L = np.asarray(L, dtype=np.float64)
    if L.ndim != 2 or not np.isfinite(L).all() or (L < 0).any():
        raise ValueError("luminance must be (H, W), finite and not negative")
    for knob in (key, phi, threshold) + (() if white is None else (white,)):
        if isinstance(knob, str) or not knob > 0:
            raise ValueError("knobs must be positive")
    if not (L > 0).any():
        return np.zeros(L.shape, np.float32)
    delta = 1e-6 * np.median(L[L > 0])
    Lm = key * L / np.exp(np.mean(np.log(delta + L)))
    if white is None:
        white = max(1.0, np.quantile(Lm, 0.9999))
    V = Lm
    if local:
        blurred = [gaussian_filter(Lm, 1.6**i / 4) for i in range(9)]
        V = blurred[0]
        even = np.ones(L.shape, dtype=bool)
        for i in range(8):
            s = 1.6**i
            response = (blurred[i] - blurred[i + 1]) / (2**phi * key / s**2 + blurred[i])
            even &= np.abs(response) < threshold
            V = np.where(even, blurred[i], V)
    Ld = Lm * (1 + Lm / white**2) / (1 + V)
    return np.minimum(Ld, 1).astype(np.float32)
