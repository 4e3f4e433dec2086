"""The screen in front of the reader: two matches by eye, and the settings that suit this screen.

gray, dark  pixel values, 0 to 1, that the reader sets; see `calibration.matching`
E           radiance (H, W) or (H, W, 3), any linear unit; the page stores scaled half floats
ln L, ln Ld  edges and heights of Ward's curve for each contrast, from 4 to 12 stops

The script uses the formulas of `calibration.matching`, `tonemap.ward` and `core.colour` for each frame
of the display. A test compares the pictures.
"""

import numpy as np
import traitlets

from hdrlab.calibration import matching
from hdrlab.core import colour
from hdrlab.core.arrays import ArrayLike, as_radiance
from hdrlab.errors import InputError
from hdrlab.io import web
from hdrlab.show.pictures import Picture, encode, require_alt
from hdrlab.show.plots.figures import fit
from hdrlab.show.widgets.scripts import Widget, script
from hdrlab.tonemap import ward

# A larger map is reduced to the means of k x k pixels.
MAX_MAP_SIDE = 400
# The curves are stored with this many decimals of ln L and ln Ld; a step is a thousandth of a code.
CURVE_DECIMALS = 5
# The sliders start far from the match on any usual screen, so that they suggest no result.
FIRST_GRAY = 150 / 255
FIRST_DARK = 24 / 255
# Contrast of the picture for comparison: the default of the operator.
DEFAULT_CONTRAST = 100.0


class ScreenMatch(Widget):
    """Two fields to match by eye, and a scene with settings for the screen that they measure.

    The script shows no result before the reader has moved both sliders.
    """

    _esm = script("half.js", "srgb.js", "histogram.js", "screen.js")
    gray = traitlets.Float(FIRST_GRAY).tag(sync=True)
    dark = traitlets.Float(FIRST_DARK).tag(sync=True)
    thresholds = traitlets.List(traitlets.Float()).tag(sync=True)  # smallest, usual, largest
    match_error = traitlets.Float(0.02).tag(sync=True)
    radiance = traitlets.Bytes().tag(sync=True)  # half floats (H, W, channels)
    scale = traitlets.Float(1.0).tag(sync=True)
    shape = traitlets.List(traitlets.Int()).tag(sync=True)  # (H, W, channels)
    stops = traitlets.List(traitlets.Float()).tag(sync=True)  # of each curve
    spans = traitlets.List(traitlets.List(traitlets.Float())).tag(sync=True)  # ends of ln L
    curves = traitlets.List(traitlets.List(traitlets.Float())).tag(sync=True)  # ln Ld
    usual = traitlets.Int(0).tag(sync=True)  # the last curve, of the picture for comparison
    alt = traitlets.Unicode().tag(sync=True)
    picture = traitlets.Bytes().tag(sync=True)  # WebP, the picture for comparison

    @property
    def screen(self) -> matching.Screen:
        """The screen that the current positions of the sliders measure."""
        return matching.measure(self.gray, self.dark)

    def still(self) -> Picture:
        """Return the scene as it is prepared for a screen of unknown kind."""
        return Picture((self.picture,), (self.alt,), ("for any screen",))


def screen_match(
    E: ArrayLike, *, alt: str, gray: float = FIRST_GRAY, dark: float = FIRST_DARK
) -> ScreenMatch:
    """Return a widget that measures gamma and black of the reader's screen with two sliders.

    Below the sliders is the scene E, tone mapped by `tonemap.ward`: for any screen, and with the
    contrast and the gamma that were measured.

    Parameters
    ----------
    E : (H, W) or (H, W, 3)
        Radiance; a map of more than 400 pixels on a side is reduced to means of k x k pixels.
    alt : str
        What the scene shows; the widget adds the settings.
    gray, dark : float
        Pixel values, 0 to 1, at which the sliders are at first.

    Raises
    ------
    InputError
        For radiance that is not finite or negative, a scene without light, pixel values that are
        not 0 < dark < gray < 1, or an empty alt text.

    Examples
    --------
    >>> E = np.geomspace(1, 2.0**8, 320)[None] * np.ones((240, 1))
    >>> figure = screen_match(E, alt="A wedge", gray=186 / 255, dark=5 / 255)
    >>> round(figure.screen.gamma, 2), round(figure.screen.stops, 1)
    (2.2, 6.8)
    """
    matching.measure(gray, dark)
    E = np.asarray(fit(as_radiance(E), MAX_MAP_SIDE))
    L = colour.luminance(E)
    if not L.any():
        raise InputError("expected a scene with light, got only zeros")
    low, high = matching.SETTING_STOPS
    steps = matching.SETTING_STEPS_PER_STOP
    stops = np.linspace(low, high, int(steps * (high - low)) + 1)
    contrasts = [*2**stops, DEFAULT_CONTRAST]
    curves = [ward.curve(L, white=contrast) for contrast in contrasts]
    data, scale = web.encode_halves(E)
    height, width = L.shape
    smallest, largest = matching.THRESHOLD_RANGE
    return ScreenMatch(
        gray=gray,
        dark=dark,
        thresholds=[smallest, matching.THRESHOLD, largest],
        match_error=matching.MATCH_ERROR,
        radiance=data,
        scale=scale,
        shape=[height, width, 3 if E.ndim == 3 else 1],
        stops=np.log2(contrasts).tolist(),
        spans=[[lnL[0], lnL[-1]] for lnL, _ in curves],
        curves=[lnLd.round(CURVE_DECIMALS).tolist() for _, lnLd in curves],
        usual=len(stops),
        alt=require_alt(alt),
        picture=encode(colour.render(E, L, ward.tonemap(L, white=DEFAULT_CONTRAST))),
    )
