"""Exposure fusion.

If every photo is flat or gray, all photos have the same weight, whatever the rounding.
"""

import numpy as np

from pairs import photographs


def weighed(kind, rng):
    return (photographs(kind, rng),), {"powers": (0.5, 2, 1)} if kind == "colour" else {}


def fused(kind, rng):
    return (photographs(kind, rng, frames=4),), {
        "contrast": 0.5,
        "saturation": 2.0,
    } if kind == "deep" else {}


def added(kind, rng):
    W = photographs(kind, rng)[0]
    detail = np.moveaxis(np.atleast_3d(photographs(kind, rng)[1]), -1, 0)
    W = np.float32(np.atleast_3d(W)[..., 0] / 255)
    return (np.ones(detail.shape, np.float32), W, np.float32(detail)), {}


PAIRS = {
    "add_term": (added, 1e-6),
    "weights": (weighed, 1e-5),
    "fuse_steps": (fused, 1e-5),
    "fuse": (fused, 1e-5),
}
