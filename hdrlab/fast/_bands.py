"""Compute an equation over a picture in bands of rows, which stay in the processor's cache.

An equation that looks at neighbours gives the same result for the rows of a band as for the whole
picture, if it gets a slab with `margin` more rows on either side, or up to the end of the picture.
"""

from collections.abc import Callable

import numpy as np

from hdrlab.core.arrays import Array
from hdrlab.core.threads import map_in_threads
from hdrlab.errors import InputError

BAND_ROWS = 32


def banded(equation: Callable[..., Array], *pictures: Array, margin: int = 0) -> Array:
    """Return equation(*pictures), (H, W), computed in bands of rows.

    Parameters
    ----------
    equation : function of slabs (..., h, W), one of each picture, that returns (h, W)
    pictures : (H, W) each, or planes (..., H, W)
    margin : number of rows above and below a pixel that its value depends on

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
        start = max(top - margin, 0)
        stop = min(top + BAND_ROWS + margin, n)
        slabs = [picture[..., start:stop, :] for picture in pictures]
        result = equation(*slabs)
        return result[top - start : top - start + BAND_ROWS]

    tops = range(0, n, BAND_ROWS)
    bands = map_in_threads(compute, tops, pixels=pictures[0].size)
    for top, band in zip(tops, bands, strict=True):
        if whole is None:
            whole = np.empty((n, band.shape[1]), band.dtype)
        whole[top : top + BAND_ROWS] = band
    if whole is None:
        raise InputError("expected pictures of at least one row")
    return whole
