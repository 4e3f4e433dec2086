"""scipy's correlate, without a transform, in float32."""

import numpy as np
from scipy.ndimage import gaussian_filter
from scipy.signal import correlate


def correlation(X):
    kept = np.isfinite(X)
    filled = np.where(kept, X, 0).astype(np.float32)
    a, b = (
        k * (f - gaussian_filter(f, 4.0) / gaussian_filter(k.astype(np.float32), 4.0))
        for f, k in zip(filled, kept)
    )
    return correlate(a, b, mode="full", method="direct")
