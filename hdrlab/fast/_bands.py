"""An equation over a picture, a band of rows at a time, which stays in the processor's cache.

Written for a whole picture, an equation of neighbours gives the same answer in the rows of a band
if the slab it is given reaches `margin` rows further on either side, and ends only where the
picture does.
"""

from collections.abc import Callable

import numpy as np

from hdrlab.core.arrays import Array
from hdrlab.core.threads import map_in_threads
from hdrlab.errors import InputError

BAND = 32  # rows


def banded(equation: Callable[..., Array], *pictures: Array, margin: int = 0) -> Array:
    """Return equation(*pictures), (H, W), computed in bands.

    Parameters
    ----------
    equation : function of slabs (..., h, W), one of each picture, to (h, W)
    pictures : (H, W) each, or planes (..., H, W)
    margin : rows above and below a pixel that the equation looks at

    Returns
    -------
    (H, W)

    Examples
    --------
    >>> u, down = np.arange(300.0).reshape(100, 3) ** 2, lambda u: np.gradient(u, axis=0)
    >>> np.array_equal(banded(down, u, margin=1), down(u))
    True
    """
    n = pictures[0].shape[-2]
    whole: Array | None = None

    def compute(top: int) -> Array:
        start, stop = max(top - margin, 0), min(top + BAND + margin, n)
        slab = equation(*(picture[..., start:stop, :] for picture in pictures))
        return slab[top - start : top - start + BAND]

    tops = range(0, n, BAND)
    for top, slab in zip(tops, map_in_threads(compute, tops, pixels=pictures[0].size), strict=True):
        whole = np.empty((n, slab.shape[1]), slab.dtype) if whole is None else whole
        whole[top : top + BAND] = slab
    if whole is None:
        raise InputError("expected pictures of at least one row")
    return whole
