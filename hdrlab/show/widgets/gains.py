"""A gain map on screens of different headroom: drag the peak of the screen, and see what it shows.

s          base image     (H, W, 3) uint8, sRGB; decoded, 1 = white of the screen
g          gain map       (H, W, 3), 0 to 1, of gains from `low` to `high`, stops, of each channel
headroom   of the gain map: the ratio of the brightest light to white
W          fraction of the gain that a screen applies

The script uses the formulas of `core.gainmap` for each frame of the display. A test compares the
pictures.
"""

import numpy as np
import traitlets

from hdrlab.core import colour, gainmap
from hdrlab.core.arrays import ArrayLike, describe
from hdrlab.errors import InputError
from hdrlab.show.pictures import Picture, encode, require_alt
from hdrlab.show.widgets.pixel import deflate
from hdrlab.show.widgets.scripts import Widget, script

MAX_CODE = 255
# The axis leaves out the darkest pixels, and goes a stop beyond the headroom of the gain map.
AXIS_QUANTILE = 0.01
STOPS_BEYOND_HEADROOM = 1


class GainScreen(Widget):
    """A base image with its gain map; `screen` is the headroom of the screen that shows them."""

    _esm = script("srgb.js", "drag.js", "histogram.js", "gains.js")
    base = traitlets.Bytes().tag(sync=True)  # deflated differences, (3, H, W)
    gains = traitlets.Bytes().tag(sync=True)  # as base: codes of the gain map
    shape = traitlets.List(traitlets.Int()).tag(sync=True)  # (H, W)
    low = traitlets.List(traitlets.Float()).tag(sync=True)
    high = traitlets.List(traitlets.Float()).tag(sync=True)
    offsets = traitlets.List(traitlets.Float()).tag(sync=True)
    headroom = traitlets.Float(8.0).tag(sync=True)
    span = traitlets.List(traitlets.Int()).tag(sync=True)  # ends of the axis of log2 of luminance
    screen = traitlets.Float(2.0).tag(sync=True)
    alt = traitlets.Unicode().tag(sync=True)
    picture = traitlets.Bytes().tag(sync=True)  # WebP, on the first screen

    def still(self) -> Picture:
        """Return what the first screen shows."""
        caption = f"a screen that shows {self.screen:g} times its white"
        return Picture((self.picture,), (self.alt,), (caption,))


def gain_screen(
    base: ArrayLike,
    g: ArrayLike,
    low: ArrayLike,
    high: ArrayLike,
    *,
    alt: str,
    headroom: float = 8.0,
    screen: float = 2.0,
) -> GainScreen:
    """Return a widget in which the headroom of a screen is dragged, with what that screen shows.

    The picture is a photo of the screen, at an exposure that is the same for all screens: light of
    `headroom` times the screen's white is white in it.

    Parameters
    ----------
    base : (H, W, 3) uint8
        The base image, sRGB.
    g : (H, W, 3)
        The gain map, 0 to 1; it is rounded to 8 bits.
    low, high : (3,)
        The gains of 0 and of 1 in the gain map, in stops.
    alt : str
        What the image shows; the widget adds the screen.
    headroom : float
        Headroom of the gain map, above 1.
    screen : float
        Headroom of the screen at first, at least 1.

    Raises
    ------
    InputError
        For images of other shapes, a gain map beyond 0 to 1, a headroom out of range, or an empty
        alt text.

    Examples
    --------
    >>> base = np.full((4, 6, 3), 188, np.uint8)
    >>> gain_screen(base, np.ones((4, 6, 3)), [0] * 3, [2] * 3, alt="Gray").span
    [-1, 4]
    """
    base = np.asarray(base)
    g = np.asarray(g, np.float64)
    if base.dtype != np.uint8 or base.ndim != 3 or base.shape[2] != 3 or base.shape != g.shape:
        raise InputError(
            f"expected a base image (H, W, 3) uint8 and a gain map of its shape, "
            f"got {describe(base)} and {describe(g)}"
        )
    if not np.all((g >= 0) & (g <= 1)):
        raise InputError("expected a gain map from 0 to 1")
    if not (1 < headroom < np.inf and 1 <= screen < np.inf):
        raise InputError(
            f"expected a headroom above 1 and a screen of at least 1, got {headroom} and {screen}"
        )
    low = np.broadcast_to(np.asarray(low, np.float64), 3)
    high = np.broadcast_to(np.asarray(high, np.float64), 3)
    codes = np.rint(MAX_CODE * g).astype(np.uint8)
    s = colour.decode_srgb(base / np.float64(MAX_CODE))
    light = gainmap.apply_gain(s, codes / MAX_CODE, low, high, W=gainmap.weight(screen, headroom))
    darkest = np.quantile(np.maximum(colour.luminance(s), 1e-4), AXIS_QUANTILE)
    return GainScreen(
        base=deflate(np.moveaxis(base, -1, 0)),
        gains=deflate(np.moveaxis(codes, -1, 0)),
        shape=list(base.shape[:2]),
        low=low.tolist(),
        high=high.tolist(),
        offsets=list(gainmap.OFFSETS),
        headroom=headroom,
        span=[
            min(int(np.floor(np.log2(darkest))), -1),
            int(np.ceil(np.log2(headroom))) + STOPS_BEYOND_HEADROOM,
        ],
        screen=screen,
        alt=require_alt(alt),
        picture=encode(colour.to_8bit(np.clip(light / headroom, 0, 1))),
    )
