"""Signals for HDR screens, which can be brighter than white, from a radiance map.

The light of the map keeps its ratios. It is scaled to the brightness of a tone-mapped image, so
that midtones look alike on both screens, and clipped where the brightest screen ends. White is as
bright as paper under good light, 203 cd/m2 [ITU-R BT.2408]; so PQ, which ends at 10,000 cd/m2, can
show light that is 49 times brighter.
"""

import numpy as np

from hdrlab.core import arrays, colour, gainmap, gamut
from hdrlab.io.web import as_rgb
from hdrlab.tonemap.transfer import PEAK_LUMINANCE, pq

WHITE_LUMINANCE = 203.0  # cd/m2


def signal(hdr: arrays.ArrayLike, *, primaries: str = "bt2020") -> arrays.F64:
    """Return the PQ signal (H, W, 3), 0 to 1, of light with the primaries of sRGB whose white is 1.

    Examples
    --------
    >>> signal(np.float32([[[1, 1, 1], [8, 8, 8]]])).round(2).tolist()
    [[[0.58, 0.58, 0.58], [0.8, 0.8, 0.8]]]
    """
    to_primaries = gamut.conversion_matrix(gamut.SRGB, gamut.WIDE[primaries])
    luminance = WHITE_LUMINANCE * (np.asarray(hdr) @ to_primaries.T)
    return pq(np.clip(luminance, 0, PEAK_LUMINANCE))


def light(
    picture: arrays.ArrayLike, E: arrays.ArrayLike, *, headroom: float = np.inf
) -> arrays.F32:
    """Return the light of a radiance map (H, W, 3), 1 = white, at the brightness of its picture.

    Both have the same mean of log luminance.
    """
    rgb = as_rgb(arrays.as_picture(picture))
    sdr = colour.decode_srgb(rgb / np.float32(255))
    return gainmap.expose(as_rgb(arrays.as_radiance(E)), sdr, headroom)
