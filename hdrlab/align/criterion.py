"""How well one photograph lies on another: the normalised difference of their light [Cerman06 eq. 6].

X  light          (2, h, w): the fixed photograph and the moving one on one scale, NaN where discarded
H  move           (3, 3): where pixel (x, y, 1) of the moving photograph lies on the fixed one
p  pixels         (n, 2), (x, y): those of the fixed photograph that are compared
d  differences    (n,): (a - b) / max((a + b) / 2, t), relative to the light; NaN where one shows nothing
t  least light    a thousandth of the largest, so that darkness does not count as contrast
e  error          mean of d^2
"""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from hdrlab.core import warp

Float = NDArray[np.float64]
Light = NDArray[np.float32]
POINTS = 8_000  # an even choice of so many pixels tells a move as well as all of them
LEAST = 0.02  # of those pixels both photographs must show
NONE = 4.0  # e of photographs of which one is dark wherever the other is bright


def lattice(shape: tuple[int, ...], points: int = POINTS) -> Float:
    """Return about so many pixels p, spread evenly over a picture."""
    step = max(1, int(np.sqrt(shape[0] * shape[1] / points)))
    y, x = np.mgrid[step // 2 : shape[0] : step, step // 2 : shape[1] : step]
    return np.stack([x.ravel(), y.ravel()], axis=-1).astype(float)


def differences(X: Light, H: Float, p: Float) -> Float:
    """Return d at the pixels p."""
    q = warp.apply(np.linalg.inv(H), p)
    b = map_coordinates(X[1], q.T[::-1], order=1, cval=np.nan, output=np.float64)
    at = p.astype(int)
    a = X[0][at[:, 1], at[:, 0]].astype(np.float64)
    t = 1e-3 * float(np.nanmax(X[0])) if np.isfinite(X[0]).any() else 1.0
    return np.asarray((a - b) / np.maximum((a + b) / 2, t))


def error(d: Float) -> float:
    """Return e; NONE where the two share too few pixels.

    Examples
    --------
    >>> error(np.array([0.1, -0.3, np.nan]))
    0.05
    """
    seen = d[np.isfinite(d)]
    return float(np.mean(seen**2)) if len(seen) > LEAST * len(d) else NONE
