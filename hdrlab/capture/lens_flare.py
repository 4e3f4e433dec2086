"""Flare: what a lens makes of a bright light beside its picture, with the truth known.

E   radiance before the lens    (H, W[, 3]) float32, any linear unit
F   radiance behind it          (H, W[, 3]), (1 - share) E + share (K * E): see `core.filters.scatter`
k   place of a reflection       a light at p from the middle has its image at k p; k < 0 lies across from it
a   aperture                    the image is a disc of this radius, pixels

Two things happen. A little of all light is scattered, and lies over the picture as veiling glare. And light
that is reflected by two surfaces on its way comes to a focus elsewhere: discs in a row through the middle.
"""

import numpy as np
from numpy.typing import ArrayLike
from scipy.ndimage import affine_transform
from scipy.signal import fftconvolve

from hdrlab.core.arrays import as_radiance
from hdrlab.core.filters.scatter import GlareSpread, scatter, spread_transform, validate_spread
from hdrlab.core.types import F32

FINGERPRINTS = GlareSpread(0.05)


def add_glare(E: ArrayLike, spread: GlareSpread = FINGERPRINTS) -> F32:
    """Return the radiance behind a lens that scatters, (1 - share) E + share (K * E).

    Parameters
    ----------
    E : (H, W) or (H, W, 3), radiance, any linear unit
    spread : GlareSpread of the lens; a clean one scatters 1 or 2 %, one with fingerprints 10 %

    Raises
    ------
    ValueError
        For radiance or a spread that mean nothing.

    References
    ----------
    Talvala, Adams, Horowitz and Levoy, Veiling glare in high dynamic range imaging, SIGGRAPH 2007.

    Examples
    --------
    >>> E = np.full((20, 30), 0.01, np.float32)
    >>> E[10, 15] = 1000  # a lamp
    >>> F = add_glare(E, GlareSpread(0.02))
    >>> bool(F[10, 18] > 10 * F[0, 0] > 0.1), float(F[10, 15].round(1))
    (True, 980.0)
    """
    share, power, core = validate_spread(spread)
    E = as_radiance(E)
    if share == 0:
        return E.copy()
    return np.float32(1 - share) * E + np.float32(share) * scatter(E, spread_transform(E.shape, power, core))


def reflect(E: ArrayLike, *, place: float = -0.6, radius: float = 12.0, share: float = 1e-4) -> F32:
    """Return the light of one reflection alone: the picture k times as large, as discs, a share of its light.

    Parameters
    ----------
    E : (H, W) or (H, W, 3), radiance, any linear unit
    place : k, from the middle of the frame, not 0
    radius : of the aperture's disc, pixels
    share : of the light of a point that its disc receives in all

    Raises
    ------
    ValueError
        For radiance or knobs that mean nothing.

    Examples
    --------
    >>> E = np.zeros((41, 61), np.float32)
    >>> E[10, 20] = 1e6
    >>> y, x = np.nonzero(reflect(E, place=-0.5, radius=3, share=0.01) > 1)
    >>> float(y.mean().round()), float(x.mean().round())  # (10, 20) before (20, 30), half as far behind it
    (25.0, 35.0)
    """
    E = as_radiance(E)
    if not (place != 0 and abs(place) < np.inf and 0 < radius < np.inf and 0 <= share < 1):
        got = f"place {place}, radius {radius}, share {share}"
        raise ValueError(f"expected a place that is not 0, a positive radius and a share below 1, got {got}")
    planes = E.reshape(*E.shape[:2], -1)
    middle = (np.array(E.shape[:2]) - 1) / 2
    y, x = np.ogrid[-int(radius) - 1 : int(radius) + 2, -int(radius) - 1 : int(radius) + 2]
    disc = np.clip(radius + 0.5 - np.hypot(y, x), 0, 1).astype(np.float32)
    out = np.empty_like(planes)
    for c in range(planes.shape[-1]):
        whole = fftconvolve(planes[..., c], disc / disc.sum(), mode="same")  # discs first: no light is lost
        scaled = affine_transform(whole, [1 / place] * 2, middle - middle / place, order=1)
        out[..., c] = np.float32(share) * np.maximum(scaled, 0)
    return out.reshape(E.shape)
