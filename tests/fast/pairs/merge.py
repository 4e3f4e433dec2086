"""Brackets of every kind, each channel with a curve of its own."""

import numpy as np

from hdrlab.capture import responses
from hdrlab.core import weights
from pairs import photographs


def bracket(kind, rng):
    images = photographs(kind, rng, frames=5)
    n = np.iinfo(images.dtype).max + 1
    g = responses.true_g("film", n)
    if kind == "colour":
        images[:, 3:9, 5:9, 0] = 255  # one channel clipped in every frame
        g = np.stack([g, responses.true_g("gamma", n), g + 0.3], axis=-1)
    # dark; from dark to clipped
    images[:, :1, :2] = 0
    images[-1, :1, 1] = n - 1
    return (
        images,
        [4.0, 1.0, 0.25, 16.0, 64.0],
        g,
        *([weights.gaussian(n)] if kind == "gray" else []),
    ), {}


def masked(kind, rng):
    (images, *rest), _ = bracket(kind, rng)
    if kind in ("random", "colour"):
        images[:, 11, 6] = 255  # a stuck pixel, unless its neighbours are as bright
    method = {"flat": "likelihood", "gray": "mean", "colour": "shot"}.get(kind, "log")
    valid = rng.random(images.shape[:3]) > 0.3
    return (images, *rest), {"method": method, "valid": valid if kind != "random" else None}


PAIRS = {"merge": (bracket, 1e-5), "merge_with_quality": (masked, 1e-5)}
