"""What is left of the noise of a path tracer, taken out by averaging over places that look alike.

A, B     radiance (H, W, 3) of one place, each from half of the paths: their difference is noise
rho      reflectance (H, W, 3) of what is seen
guides   (H, W, G), what tells surfaces apart and has next to no noise: normal, ln depth, rho

Radiance over reflectance is light, which is smoother than the surface it falls on. Two places count
as alike where the patches around them differ by no more than the noise does [Rousselle12 sec. 4]
and their guides agree [Rousselle13 sec. 4]. Each half is averaged with the weights of the other,
which do not know its noise.
"""

from functools import partial
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter, maximum_filter, uniform_filter

Float = NDArray[np.floating[Any]]

# what reflects less counts as reflecting that much, for noise must not be divided by nothing
DARKEST = 0.02


def variance(A: Float, B: Float) -> Float:
    """Return the variance of the noise of either half, (H, W): that of their difference, halved, smoothed."""
    return gaussian_filter(((A - B) ** 2).mean(axis=2) / 2, 2.0)


def unlike(light: Float, other: Float, var: Float, other_var: Float, *, strength: float) -> Float:
    """Return how far two patches differ beyond their noise, in units of it [Rousselle12 eq. 4]."""
    both = var + np.minimum(var, other_var)
    d = ((light - other) ** 2).mean(axis=2) - both
    return uniform_filter(d / (1e-12 + strength**2 * (var + other_var)), 5)


def believed(A: Float, B: Float) -> Float:
    """Return A without paths that met a lamp by chance: at most twice what B saw there or next to it."""
    return np.minimum(A, 2 * maximum_filter(B, (3, 3, 1)))


def average(
    means: Float,
    light: Float,
    guides: Float,
    *,
    var: Float,
    radius: int,
    strength: float,
    tolerance: float,
) -> Float:
    """Return `means` averaged with weights from `light`, the other half, and from the guides."""
    pad = ((radius, radius), (radius, radius))
    H, W = var.shape
    wide = [
        np.pad(x, (*pad, (0, 0))[: x.ndim], mode="reflect") for x in (means, light, guides, var)
    ]
    total = np.zeros((H, W, 1), np.float32)
    sums = np.zeros_like(means)
    for dy, dx in product(range(-radius, radius + 1), repeat=2):
        there = (slice(radius + dy, radius + dy + H), slice(radius + dx, radius + dx + W))
        value, other, guide, other_var = (x[there] for x in wide)
        d = np.maximum(unlike(light, other, var, other_var, strength=strength), 0)
        d = np.maximum(d, ((guides - guide) ** 2).sum(axis=2) / tolerance**2)
        w = np.exp(-np.minimum(d, 50))[..., None].astype(np.float32)
        total += w
        sums += w * value
    return sums / total


def denoise(
    A: Float,
    B: Float,
    rho: Float,
    guides: Float,
    *,
    radius: int = 10,
    strength: float = 0.8,
    tolerance: float = 0.12,
) -> Float:
    """Return the light on what is seen, radiance over reflectance, (H, W, 3), without most of its noise.

    Parameters
    ----------
    A, B : (H, W, 3), radiance from either half of the paths
    rho : (H, W, 3), reflectance of what is seen
    guides : (H, W, G), normal, ln depth and reflectance
    radius : pixels, half the side of the window in which places are compared
    strength : standard deviations of the noise by which patches may differ
    tolerance : by which guides may differ

    References
    ----------
    Rousselle, Knaus and Zwicker, Adaptive rendering with non-local means filtering, SIGGRAPH Asia
    2012. Rousselle, Manzi and Zwicker, Robust denoising using feature and color information,
    Pacific Graphics 2013.
    """
    under = np.maximum(rho, np.float32(DARKEST))
    a = believed(A, B) / under
    b = believed(B, A) / under
    # Comparing square roots keeps a bright spot from being taken for its neighbours' noise.
    root_a = np.sqrt(a)
    root_b = np.sqrt(b)
    alike = partial(
        average,
        guides=guides,
        var=variance(root_a, root_b),
        radius=radius,
        strength=strength,
        tolerance=tolerance,
    )
    return (alike(a, root_b) + alike(b, root_a)) / 2


def finer(light: Float, coarse: Float, guides: Float, *, tolerance: float = 0.15) -> Float:
    """Return light of a grid half as fine, (H / 2, W / 2, 3), on that of the guides, (H, W, G).

    Each pixel takes the mean of the coarse ones about it, with weights that fall with distance and
    where the guides differ [Kopf07 sec. 3]; `coarse` holds the guides of the coarse grid.

    References
    ----------
    Kopf, Cohen, Lischinski and Uyttendaele, Joint bilateral upsampling, SIGGRAPH 2007.
    """
    H, W = guides.shape[:2]
    pad = ((2, 2), (2, 2), (0, 0))
    wide = np.pad(light, pad, mode="edge")
    known = np.pad(coarse, pad, mode="edge")
    row = np.arange(H)
    column = np.arange(W)
    total = np.zeros((H, W, 1), np.float32)
    sums = np.zeros((H, W, 3), np.float32)
    for dy in range(-2, 3):
        for dx in range(-2, 3):
            y = row // 2 + dy
            x = column // 2 + dx
            there = np.ix_(y + 2, x + 2)
            away = ((2 * y + 0.5 - row) ** 2)[:, None] + (2 * x + 0.5 - column) ** 2
            d = ((guides - known[there]) ** 2).sum(axis=2) / tolerance**2
            w = (np.exp(-away / 6) * np.maximum(np.exp(-np.minimum(d, 50)), 1e-6))[
                ..., None
            ].astype(np.float32)
            total += w
            sums += w * wide[there]
    return sums / total
