"""Differences from g are clipped at sigma and nothing else is done; alpha and beta are not looked at."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    return g + np.clip(np.asarray(lL, dtype=float) - g, -sigma, sigma)
