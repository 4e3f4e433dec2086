"""Lens flare: the mirrored image of the lights that reflections inside a lens produce.

F   radiance, as photographed    (H, W[, 3]), E(x) + r E(-x), x from the middle of the picture
E   radiance without it          (H, W[, 3])
r   share of the light           that two surfaces of glass reflect, one after the other

Unlike veiling glare, it is not a haze: opposite a window, a sharp image of the window appears in
the dark corner. That makes it detectable: where a mirrored light has an edge, the map must have the
same edge, r times as high, and nothing else in the scene has its edges there.
"""

import numpy as np

from hdrlab.core.arrays import F32, ArrayLike, as_radiance
from hdrlab.core.colour import luminance
from hdrlab.errors import InputError

# fraction of the pixels that count as the steepest edges of the mirrored lights
EDGE_FRACTION = 2e-3
# glass reflects less; a more similar scene is symmetric itself
MAX_REFLECTED_SHARE = 0.2


def fit_reflection(F: ArrayLike) -> float:
    """Return r, the share of each light that appears again, mirrored through the middle, or 0.

    Where a mirrored light has its steepest edges, the map must have the same edges, r times as
    high. r is the median over these edges, and is only accepted if three quarters of them have at
    least half of it.

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
    gradient = np.array(np.gradient(L))
    mirrored = np.array(np.gradient(L[::-1, ::-1]))
    height = np.sum(mirrored**2, axis=0)
    threshold = np.quantile(height, 1 - EDGE_FRACTION)
    edges = height > max(threshold, np.finfo(np.float32).tiny)
    if not edges.any():
        return 0.0
    ratios = np.sum(gradient * mirrored, axis=0)[edges] / height[edges]
    low, r = np.quantile(ratios, [0.25, 0.5])
    return float(r) if low > r / 2 > 0 and r < MAX_REFLECTED_SHARE else 0.0


def remove_reflection(F: ArrayLike, r: float | None = None) -> F32:
    """Return E = (F(x) - r F(-x)) / (1 - r^2), the map without the mirrored image of its lights.

    Parameters
    ----------
    F : (H, W) or (H, W, 3), radiance map of a whole bracket, not cropped
    r : the share of each light that is reflected; by default `fit_reflection` estimates it

    Returns
    -------
    E : like F, float32, at least a thousandth of it

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
        raise InputError(f"expected a fraction from 0 to 1, got {r}")
    difference = F - np.float32(r) * F[::-1, ::-1]
    return np.maximum(difference, np.float32(1e-3) * F) / np.float32(1 - r**2)
