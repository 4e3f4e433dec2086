import numpy as np


def weighted_variance(x, w):
    """Mean of squares less square of the mean, about the median, so that little cancels; float32 out."""
    x = np.asarray(x, dtype=np.float64)
    w = np.asarray(w, dtype=np.float64)
    total = w.sum(axis=0)
    y = x - np.median(x, axis=0)
    norm = np.where(total > 0, total, 1.0)
    m1 = (w * y).sum(axis=0) / norm
    m2 = (w * y * y).sum(axis=0) / norm
    return np.maximum(m2 - m1 * m1, 0.0).astype(np.float32)
