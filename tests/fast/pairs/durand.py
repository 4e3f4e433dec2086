"""fast.durand: base and detail to the accuracy of the bilateral grid, on light that varies over some pixels.

In noise from pixel to pixel a base rests on few pixels, whose number k the grid knows to a fifth.
"""

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.core.filters.bilateral import bilateral
from pairs import luminance


def light(kind, rng):
    """Smooth log luminance, decades."""
    return gaussian_filter(np.log10(luminance(kind, rng)), 2)


def split(kind, rng):
    """Log luminance in decades."""
    if kind == "colour":
        return None  # operators take luminance
    return (light(kind, rng),), {"sigma_s": 6.0 if kind == "gray" else 3.0}


def filtered(kind, rng):
    """A filtered picture, and the k of its base."""
    if kind == "colour":
        return None
    return tuple(bilateral(np.log10(luminance(kind, rng)), sigma_s=3.0, sigma_r=0.4)), {
        "sigma_s": 3.0
    }


def both(kind, rng):
    """A base, and detail on it."""
    if kind == "colour":
        return None
    base = light(kind, rng)
    return (base, np.float32(0.1 * rng.standard_normal(base.shape))), {}


def shown(kind, rng):
    """Luminance, and other knobs for some kinds."""
    if kind == "colour":
        return None
    knobs = {"gray": {"contrast": 5.0, "sigma_s": 5.0}, "clipped": {"cut": 0.0, "sigma_r": 1.0}}
    return (10 ** light(kind, rng),), {"sigma_s": 3.0, **knobs.get(kind, {})}


PAIRS = {
    "layers": (split, 0.03),
    "fix_uncertain": (filtered, 1e-5),
    "combine": (both, 1e-6),
    "tonemap": (shown, 0.05),
}
