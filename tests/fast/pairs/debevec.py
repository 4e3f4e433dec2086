"""Samples and photos for gsolve; both functions refuse levels that no two exposures connect."""

import numpy as np

from hdrlab.core import sampling, weights
from pairs import photographs


def samples(kind, rng):
    """Return Z, B, lambda and w; `deep` has many samples, `clipped` a cut, `colour` few levels."""
    n = 32 if kind == "colour" else 256
    Z = sampling.by_grid(
        photographs("gray" if kind == "colour" else kind, rng), 90 if kind == "deep" else 30
    )
    w = weights.cut(weights.hat(n)) if kind == "clipped" else weights.gaussian(n)
    return (Z * n // 256, np.log([0.25, 1, 4]), 30.0, w), {}


def bracket(kind, rng):
    """Return photographs whose levels rise with the times."""
    return (photographs(kind, rng), [0.25, 1, 4]), {"samples": 60}


PAIRS = {"gsolve": (samples, 1e-7), "recover": (bracket, 1e-7)}
