"""Wrong: divides by the brightest and takes a gamma of 2.2; key and neighbourhood do not matter."""

import numpy as np


def tonemap(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    L = np.asarray(L, dtype=float)
    if L.ndim != 2 or not np.isfinite(L).all() or (L < 0).any():
        raise ValueError("luminance must be (H, W), finite and not negative")
    top = L.max() if white is None else white
    return np.clip(L / max(top, 1e-12), 0, 1).astype(np.float32) ** np.float32(1 / 2.2)
