"""Flare: what a lens makes of a bright light beside its picture, with the truth known.

E   radiance before the lens    (H, W[, 3]) float32, any linear unit
F   radiance behind it          (H, W[, 3]), (1 - share) E + share (K * E): see `core.filters.scatter`

A little of all light is scattered, and lies over the picture as veiling glare.
"""

import numpy as np

from hdrlab.core.arrays import F32, ArrayLike, as_radiance
from hdrlab.core.filters.scatter import GlareSpread, scatter, spread_transform, validate_spread

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
    return np.float32(1 - share) * E + np.float32(share) * scatter(
        E, spread_transform(E.shape, power, core)
    )
