"""Image pyramids: planes if there are colors, and all kinds of sides."""

import numpy as np

from hdrlab.core.filters.pyramid import half_shape, laplacian as plain
from pairs import luminance, photographs


def image(kind, rng):
    """Return an image (H, W) float32, or planes (3, H, W)."""
    if kind in ("deep", "gray", "colour"):
        Z = photographs(kind, rng)[1]
        return np.moveaxis(np.atleast_3d(Z), -1, 0).astype(np.float32) / np.iinfo(Z.dtype).max
    return np.minimum(luminance(kind, rng), 50)


def make_image(kind, rng):
    return (image(kind, rng),), {}


def finer(kind, rng):
    """Return a single plane, and the sides of the next finer level: odd ones too."""
    shape = image(kind, rng).shape[-2:]
    coarse = image(kind, rng).reshape(-1, *shape)[0][: half_shape(shape)[0], : half_shape(shape)[1]]
    return (coarse, shape), {}


def several(kind, rng):
    return (image(kind, rng), 4), {}


def details(kind, rng):
    return (plain(image(kind, rng), 4),), {}


PAIRS = {
    "reduce": (make_image, 1e-6),
    "interpolate": (finer, 1e-6),
    "gaussian": (several, 1e-6),
    "laplacian": (several, 1e-6),
    "collapse": (details, 1e-6),
}
