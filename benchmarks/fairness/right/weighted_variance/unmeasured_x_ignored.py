import numpy as np


def weighted_variance(x, w):
    """As asked, and an x of weight 0 has no say even if it is -inf or NaN (ln 0)."""
    w = np.asarray(w, dtype=np.float64)
    x = np.where(w > 0, np.asarray(x, dtype=np.float64), 0.0)
    total = np.einsum("phw->hw", w)
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = np.einsum("phw,phw->hw", w, x) / total
        v = np.einsum("phw,phw->hw", w, np.square(x - mean)) / total
    v[total == 0] = 0
    return v
