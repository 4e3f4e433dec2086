"""The unit of light that a view transform expects, such as 0.18 for middle gray.

E        radiance                       (H, W, 3) >= 0, any linear unit
Lav      log average of its luminance   same unit
key      what Lav becomes               0.18 is middle gray
C        color in the transform's unit  (H, W, 3)

A renderer knows how bright its scene is. A radiance map often does not, so it is scaled like
Reinhard's operator scales luminance: what is as bright as the scene on the whole becomes middle gray.
"""

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, as_radiance, describe
from hdrlab.core.colour import luminance
from hdrlab.errors import InputError
from hdrlab.tonemap.reinhard import log_average


def scale_colors(E: ArrayLike, *, key: float) -> F64:
    """Return C = E key / Lav.

    Parameters
    ----------
    E : (H, W, 3) radiance, finite and not negative, any linear unit
    key : what the log average of luminance becomes

    Returns
    -------
    (H, W, 3) float64

    Raises
    ------
    InputError
        For radiance that is not (H, W, 3), finite and at least 0, and a key that is not positive.

    Examples
    --------
    >>> scale_colors(np.full((1, 1, 3), 300.0), key=0.18).round(6)
    array([[[0.18, 0.18, 0.18]]])
    """
    E = as_radiance(E)
    if E.ndim != 3:
        raise InputError(f"expected colors (H, W, 3), got {describe(E)}; gray light has `tonemap`")
    if not 0 < key < np.inf:
        raise InputError(f"expected a key above 0, got {key}")
    Lav = log_average(luminance(E).astype(np.float64))
    return E.astype(np.float64) * (key / Lav)
