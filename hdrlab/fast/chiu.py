"""Chiu's spatially nonuniform scaling, fast: blurs on coarse grids, smoothing in bands of rows."""

from hdrlab.core.arrays import F32
from hdrlab.fast import _bands, blur, with_parts
from hdrlab.fast.bilateral import bilateral
from hdrlab.tonemap import chiu


def smooth(s: F32, L: F32) -> F32:
    """Return s after the lesson's smoothing pass, computed in bands of rows."""
    return _bands.banded(chiu.smooth, s, L, margin=1)


scale = with_parts(__name__, chiu.scale, gaussian_filter=blur.gaussian)
tonemap_steps = with_parts(__name__, chiu.tonemap_steps, scale=scale, smooth=smooth)
tonemap = with_parts(__name__, chiu.tonemap, tonemap_steps=tonemap_steps)
halo = with_parts(__name__, chiu.halo, bilateral=bilateral)
