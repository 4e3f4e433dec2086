"""Fattal's operator: logarithms of luminance, several levels of them."""

import numpy as np

from pairs import luminance


def scene(kind, rng):
    """Return luminance, large enough for a second level where the kind allows it."""
    L = luminance(kind, rng)
    return np.kron(L, np.ones((4, 3), np.float32)) if min(L.shape) > 20 else L


def tonemap(kind, rng):
    if kind == "colour":
        return None  # operators get only luminance
    return (scene(kind, rng),), {"beta": 0.8} if kind == "gray" else {}


def logarithm(kind, rng):
    L = tonemap(kind, rng)
    return L and ((np.log(L[0][0]),), {"alpha": 0.3} if kind == "gray" else {})


def attenuated(kind, rng):
    L = tonemap(kind, rng)
    return L and ((np.log(L[0][0]), rng.uniform(0.2, 2, L[0][0].shape).astype(np.float32)), {})


PAIRS = {
    "attenuation_steps": (logarithm, 1e-5),
    "divergence": (attenuated, 1e-6),
    "tonemap": (tonemap, 1e-4),
}
