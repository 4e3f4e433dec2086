"""The Detail Brush over a whole picture, counted and read in bands of rows."""

import numpy as np

from hdrlab.core.arrays import F32, ArrayLike, as_luminance
from hdrlab.core.colour import decode_srgb
from hdrlab.fast import _bands, _lookup
from hdrlab.tonemap import brush


def tonemap(L: ArrayLike, *, bins: int = 1024, limit: float = 4.0) -> F32:
    """Return display luminance of the whole picture as one window: what the brush is compared with."""
    L = as_luminance(L)
    brush.check_knobs(bins, limit)
    low, high = brush.find_range(L)
    t = _bands.banded(lambda L: brush.bin_position(L, low, high, bins), L)
    parts = [t[top : top + _bands.BAND] for top in range(0, len(t), _bands.BAND)]
    h = sum((brush.histogram(part, bins) * (part.size / t.size) for part in parts), np.zeros(bins))
    table = _lookup.tabulate(decode_srgb(brush.cumulative(brush.clip_histogram(h, limit=limit))))
    return _bands.banded(lambda t: _lookup.interpolate(table, t), t)
