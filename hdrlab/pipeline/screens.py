"""A radiance map for a screen that can be brighter than white, beside an operator's picture for any screen.

The light of the map keeps its ratios. It is scaled to the brightness of the picture, so that what
is in the middle looks alike on both screens, and cut where the brightest screen ends. White is as
bright as paper under good light, 203 cd/m2 [ITU-R BT.2408]; so PQ, which ends at 10,000 cd/m2, has
room for 49 times of it.
"""

import numpy as np

from hdrlab.core import arrays, colour, gainmap, gamut
from hdrlab.io.web import as_rgb
from hdrlab.tonemap.transfer import BRIGHTEST, pq

WHITE = 203.0  # cd/m2


def signal(hdr: arrays.ArrayLike, *, primaries: str = "bt2020") -> arrays.F64:
    """Return PQ's signal (H, W, 3), 0 to 1, of light with the primaries of sRGB whose white is 1.

    Examples
    --------
    >>> signal(np.float32([[[1, 1, 1], [8, 8, 8]]])).round(2).tolist()
    [[[0.58, 0.58, 0.58], [0.8, 0.8, 0.8]]]
    """
    wide = np.asarray(hdr) @ gamut.conversion_matrix(gamut.SRGB, gamut.WIDE[primaries]).T
    return pq(np.clip(WHITE * wide, 0, BRIGHTEST))


def light(
    picture: arrays.ArrayLike, E: arrays.ArrayLike, *, headroom: float = np.inf
) -> arrays.F32:
    """Return the light of a map (H, W, 3), 1 = white, as bright in the mean of logarithms as its picture."""
    sdr = colour.decode_srgb(as_rgb(arrays.as_picture(picture)) / np.float32(255))
    return gainmap.expose(as_rgb(arrays.as_radiance(E)), sdr, headroom)
