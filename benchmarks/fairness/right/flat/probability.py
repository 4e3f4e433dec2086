"""Asks how probable so large a quotient is: the tail must be psi at least."""

import numpy as np
from scipy.ndimage import generic_filter, uniform_filter
from scipy.stats import chi2, f


def flat(A, *, size=5, psi=0.05, sigma=0.01):
    t, s = A.shape[0], size * size
    spread = generic_filter(A.mean(0), np.var, size=size)
    if t == 1:
        tail = chi2.sf(s * spread / sigma**2, s - 1)
    else:
        noise = uniform_filter(((A - A.mean(0)) ** 2).sum(0) / (t - 1), size)
        tail = f.sf(s * spread * t / noise / (s - 1), s - 1, s * (t - 1))
    inside = np.pad(
        np.ones((spread.shape[0] - size + 1, spread.shape[1] - size + 1), bool), size // 2
    )
    return (tail >= psi) & inside
