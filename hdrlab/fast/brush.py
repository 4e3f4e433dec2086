"""The Detail Brush over a whole picture, counted and read in bands of rows."""

import numpy as np

from hdrlab.core.arrays import F32, ArrayLike, as_luminance
from hdrlab.core.colour import decode_srgb
from hdrlab.fast import _bands, _lookup
from hdrlab.tonemap import brush


def tonemap(L: ArrayLike, *, bins: int = 1024, limit: float = 4.0) -> F32:
    """Return display luminance by histogram equalization of ln L over the whole picture."""
    L = as_luminance(L)
    brush.check_knobs(bins, limit)
    low, high = brush.find_range(L)
    t = _bands.banded(lambda L: brush.bin_position(L, low, high, bins), L)
    h = np.zeros(bins)
    for top in range(0, len(t), _bands.BAND_ROWS):
        band = t[top : top + _bands.BAND_ROWS]
        h = h + brush.histogram(band, bins) * (band.size / t.size)
    P = brush.cumulative(brush.clip_histogram(h, limit=limit))
    table = _lookup.tabulate(decode_srgb(P))
    return _bands.banded(lambda t: _lookup.interpolate(table, t), t)
