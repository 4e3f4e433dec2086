"""fast.chiu: narrow blurs within float32, wide ones within 0.2 % of their peak."""

import numpy as np

from hdrlab.tonemap import chiu
from pairs import luminance


def wide(kind):
    return {"sigma": {"gray": 6.0, "flat": 9.0}.get(kind)}


def scene(kind, rng):
    """Luminance in medians, with a narrow blur for some kinds and a wide one for others."""
    return (
        None if kind == "colour" else ((chiu.divide_by_median(luminance(kind, rng)),), wide(kind))
    )


def scaled(kind, rng):
    """A scale and the luminance that it scales."""
    if kind == "colour":
        return None
    L = luminance(kind, rng)
    return (np.float32(rng.random(L.shape)), L), {}


def measured(kind, rng):
    """Luminance and its scale, and the widths of the halo's base."""
    if kind == "colour":
        return None
    L = chiu.divide_by_median(luminance(kind, rng))
    return (L, chiu.scale(L, sigma=3.0)), {"sigma": 3.0}


PAIRS = {
    "scale": (scene, 5e-3),
    "tonemap_steps": (scene, 5e-3),
    "smooth": (scaled, 1e-6),
    "halo": (measured, 0.05),
    "tonemap": (scene, 5e-3),
}
