"""np.percentile, the higher neighbour."""

import numpy as np
from scipy.ndimage import gaussian_filter


def tonemap(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    L = np.asarray(L, dtype=float)
    if not np.all(np.isfinite(L)) or np.any(L < 0):
        raise ValueError("expected luminance that is finite and not negative")
    if key <= 0 or phi <= 0 or threshold <= 0 or (white is not None and white <= 0):
        raise ValueError("expected knobs above 0")
    if not L.any():
        return np.zeros(L.shape, np.float32)
    Lm = key * L / 10 ** np.mean(np.log10(L + 1e-6 * np.median(L[L > 0])))
    if white is None:
        white = max(1.0, float(np.percentile(Lm, 99.99, method="higher")))
    V = Lm
    if local:
        V1 = [gaussian_filter(Lm, 1.6**k / 4) for k in range(9)]
        even, V = True, V1[0]
        for k in range(8):
            even = even & (
                np.abs(V1[k] - V1[k + 1]) / (2**phi * key / 1.6 ** (2 * k) + V1[k]) < threshold
            )
            V = np.where(even, V1[k], V)
    return np.minimum(Lm * (1 + Lm / white**2) / (1 + V), 1).astype(np.float32)
