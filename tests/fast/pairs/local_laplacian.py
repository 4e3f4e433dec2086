"""fast.local_laplacian: within float32, with details kept, raised, and edges unchanged."""

import numpy as np

from pairs import luminance

KNOBS = {
    "gray": {"alpha": 1.0, "beta": 0.5},
    "flat": {"alpha": 0.5, "beta": 0.0},
    "clipped": {"alpha": 2.0, "beta": 1.0},
}


def remapped(kind, rng):
    """Log luminance in nats, a brightness within, and the curve of details and edges."""
    if kind == "colour":
        return None
    lL = np.log(luminance(kind, rng))
    return (lL, float(np.median(lL))), {
        "sigma": 0.7,
        **KNOBS.get(kind, {"alpha": 1.0, "beta": 0.0}),
    }


def logarithms(kind, rng):
    """Log luminance in nats, and all knobs."""
    if kind == "colour":
        return None
    knobs = {"sigma": 0.7, "alpha": 1.0, "beta": 0.0, "samples": 9}
    return (np.log(luminance(kind, rng)),), knobs | KNOBS.get(kind, {})


def shown(kind, rng):
    """Luminance, and other knobs for some kinds."""
    return (
        None
        if kind == "colour"
        else ((luminance(kind, rng),), {"samples": 9, **KNOBS.get(kind, {})})
    )


PAIRS = {"remap": (remapped, 1e-6), "filtered": (logarithms, 1e-5), "tonemap": (shown, 1e-4)}
