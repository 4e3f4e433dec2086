"""Reinhard's global operator on a zone scale: drag the key and the white point, and see curve and photo.

E      radiance           (H, W) or (H, W, 3), any linear unit; the page stores scaled half floats
L      luminance of E;  Lav  its log average;  Lm  a L / Lav, scaled luminance
a      key;  white  the Lm that becomes white
Ld     display luminance, Lm (1 + Lm / white^2) / (1 + Lm)
zone   5 + log2(Lm / 0.18)

The script uses the formulas of `tonemap.reinhard` and `core.colour` for each frame of the display. A
test compares the pictures.
"""

import numpy as np
import traitlets

from hdrlab.core import colour
from hdrlab.core.arrays import ArrayLike, as_radiance
from hdrlab.errors import InputError
from hdrlab.io import web
from hdrlab.show.pictures import Picture, encode, require_alt
from hdrlab.show.plots.figures import fit
from hdrlab.show.widgets.scripts import Widget, script
from hdrlab.tonemap import reinhard

# A larger map is reduced to the means of k x k pixels.
MAX_MAP_SIDE = 400
# The axis leaves out the most extreme luminances at both ends, which are single pixels.
AXIS_QUANTILES = (0.001, 0.999)
# The axis contains at least these zones: black and white of the paper, and room for the white point.
MIN_ZONES = (-1, 14)


class ZoneScale(Widget):
    """A scene, and the key and the white point of Reinhard's global operator."""

    _esm = script("half.js", "srgb.js", "drag.js", "histogram.js", "zones.js")
    radiance = traitlets.Bytes().tag(sync=True)  # half floats (H, W, channels)
    scale = traitlets.Float(1.0).tag(sync=True)
    shape = traitlets.List(traitlets.Int()).tag(sync=True)  # (H, W, channels)
    log_average = traitlets.Float(1.0).tag(sync=True)
    zones = traitlets.List(traitlets.Int()).tag(sync=True)  # ends of the axis
    key = traitlets.Float(0.18).tag(sync=True)
    white = traitlets.Float(8.0).tag(sync=True)
    alt = traitlets.Unicode().tag(sync=True)
    picture = traitlets.Bytes().tag(sync=True)  # WebP, with the first key and white point

    def still(self) -> Picture:
        """Return the tone-mapped picture with the first key and white point."""
        return Picture((self.picture,), (self.alt,), (f"key {self.key:g}, white {self.white:g}",))


def zone_scale(E: ArrayLike, *, alt: str, key: float = 0.18, white: float = 8.0) -> ZoneScale:
    """Return a widget in which Reinhard's key and white point are dragged along a zone scale.

    The histogram of the scene moves with the key, and the curve follows the white point.

    Parameters
    ----------
    E : (H, W) or (H, W, 3)
        Radiance; a map of more than 400 pixels on a side is reduced to means of k x k pixels.
    alt : str
        What the scene shows; the widget adds the key and the white point.
    key : float
        a: the scaled luminance of the scene's log average at first.
    white : float
        The scaled luminance that becomes white at first.

    Raises
    ------
    InputError
        For radiance that is not finite or negative, a scene without light, a key or a white point
        that is not positive, or an empty alt text.

    Examples
    --------
    >>> E = np.geomspace(1, 2.0**8, 320)[None] * np.ones((240, 1))
    >>> figure = zone_scale(E, alt="A wedge")
    >>> round(figure.log_average), figure.zones
    (16, [-1, 14])
    """
    E = np.asarray(fit(as_radiance(E), MAX_MAP_SIDE))
    L = colour.luminance(E)
    if not L.any():
        raise InputError("expected a scene with light, got only zeros")
    Ld = reinhard.tonemap(L, key=key, white=white)
    log_average = reinhard.log_average(L)
    low, high = 5 + np.log2(np.quantile(L[L > 0], AXIS_QUANTILES) / log_average)
    data, scale = web.encode_halves(E)
    height, width = L.shape
    return ZoneScale(
        radiance=data,
        scale=scale,
        shape=[height, width, 3 if E.ndim == 3 else 1],
        log_average=log_average,
        zones=[min(int(np.floor(low)), MIN_ZONES[0]), max(int(np.ceil(high)), MIN_ZONES[1])],
        key=key,
        white=white,
        alt=require_alt(alt),
        picture=encode(colour.render(E, L, Ld)),
    )
