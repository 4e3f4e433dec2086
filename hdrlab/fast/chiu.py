"""Chiu's spatially nonuniform scaling, fast: blurs on coarse grids, the passes a band of rows at a time."""

from hdrlab.core.bands import banded
from hdrlab.core.types import F32
from hdrlab.fast import with_parts
from hdrlab.fast.bilateral import bilateral
from hdrlab.fast.blur import gaussian
from hdrlab.tonemap import chiu


def smooth(s: F32, L: F32) -> F32:
    """Return the lesson's pass over s."""
    return banded(chiu.smooth, s, L, margin=1)


lessons = (chiu.scale, chiu.tonemap_steps, chiu.tonemap, chiu.halo)
parts = {"gaussian_filter": gaussian, "bilateral": bilateral, "smooth": smooth}
scale, tonemap_steps, tonemap, halo = with_parts(__name__, *lessons, **parts)
