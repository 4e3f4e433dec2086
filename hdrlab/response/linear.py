"""The response of a linear camera: none to recover.

A sensor counts in proportion to light, and a RAW file keeps its counts. Then f^-1(z) = z, and g =
ln z up to the constant that makes the middle level 1.

g   ln f^-1   (n,), n = 256 or 65536: at 16 bits each level has its own, lest dark ones be read between two
"""

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, as_stack, as_times, levels


def curve(n: int = 256) -> F64:
    """Return g(z) = ln(z / (n / 2)); level 0, which stands for anything below 1/2, gets ln of 1/4."""
    return np.log(np.maximum(np.arange(n), 0.25) / (n // 2))


def recover(images: ArrayLike, times: ArrayLike, **_: object) -> F64:
    """Return g of a linear camera with the images' levels; the photographs are checked, not consulted.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
    times : (P,) float, seconds

    Returns
    -------
    (n,) float64
        ln exposure of each level, g[n // 2] = 0; n = 256 or 65536.

    Raises
    ------
    ValueError
        For arrays that are no bracket.

    Examples
    --------
    >>> g = recover(np.zeros((2, 4, 4), np.uint8), [1, 2])
    >>> float(g[128]), round(float(np.exp(g[192])), 6)
    (0.0, 1.5)
    """
    stack = as_stack(images)
    as_times(times, len(stack))
    return curve(levels(stack))
