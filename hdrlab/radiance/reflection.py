"""Lens flare: the picture of its lights that a lens throws back, mirrored through the middle.

F   radiance, as photographed    (H, W[, 3]), E(x) + r E(-x), x from the middle of the picture
E   radiance without it          (H, W[, 3])
r   share of the light           that two surfaces of glass reflect, one after the other

Other than veiling glare it is no haze: a sharp window stands in the dark corner across from the
window. That gives it away. Where a mirrored light has an edge, the map must have the same edge, r
times as high, and no other thing in the scene knows where that is.
"""

import numpy as np

from hdrlab.core.arrays import F32, ArrayLike, as_radiance
from hdrlab.core.colour import luminance
from hdrlab.errors import InputError

# of the pixels: the steepest edges of the mirrored lights
EDGES = 2e-3
# of a light, more than glass throws back: what is more alike than that is symmetric itself
GLASS = 0.2


def fit_reflection(F: ArrayLike) -> float:
    """Return r, the share of each light that is seen again on the other side of the middle, or 0.

    Where a mirrored light has its steepest edges the map must have the same ones, r times as high:
    r is their median, and counts only where three in four say half of it or more.

    Parameters
    ----------
    F : (H, W) or (H, W, 3), radiance map of a whole bracket, not cropped: the lens's axis is its
        middle

    Raises
    ------
    ValueError
        For radiance that is not finite or negative.

    Examples
    --------
    >>> from hdrlab import scenes
    >>> E = scenes.chapel((128, 192))
    >>> fit_reflection(E), round(fit_reflection(E + 0.01 * E[::-1, ::-1]), 4)
    (0.0, 0.01)
    """
    L = np.pad(luminance(as_radiance(F)).astype(np.float64), 1, mode="edge")
    own, mirrored = (np.array(np.gradient(one)) for one in (L, L[::-1, ::-1]))
    height = np.sum(mirrored**2, axis=0)
    edges = height > max(np.quantile(height, 1 - EDGES), np.finfo(np.float32).tiny)
    if not edges.any():
        return 0.0
    low, r = np.quantile(np.sum(own * mirrored, axis=0)[edges] / height[edges], [0.25, 0.5])
    return float(r) if low > r / 2 > 0 and r < GLASS else 0.0


def remove_reflection(F: ArrayLike, r: float | None = None) -> F32:
    """Return E = (F(x) - r F(-x)) / (1 - r^2), the map without the lens's picture of its lights.

    Parameters
    ----------
    F : (H, W) or (H, W, 3), radiance map of a whole bracket, not cropped
    r : the share of each light that is reflected; by default `fit_reflection` finds it

    Returns
    -------
    E : like F, float32, not below a thousandth of it

    Raises
    ------
    ValueError
        For radiance that is not finite or negative, or a share outside 0 to 1.

    Examples
    --------
    >>> remove_reflection([[1.0, 0.0], [2.0, 0.1]], 0.1).round(2)
    array([[1.  , 0.  ],
           [2.02, 0.  ]], dtype=float32)
    """
    F = as_radiance(F)
    r = fit_reflection(F) if r is None else r
    if not 0 <= r < 1:
        raise InputError(f"expected a share of 0 to 1, got {r}")
    return np.maximum(F - np.float32(r) * F[::-1, ::-1], np.float32(1e-3) * F) / np.float32(
        1 - r**2
    )
