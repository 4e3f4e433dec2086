"""Fattal's operator on one line of pixels: drag the curve of attenuation, and see the line that it leaves.

lL      log luminance      (N,), ln L
G       steps              (N - 1,), differences of neighbors; slope = |G|
alpha   slope that does not change, as a multiple of the mean slope;  beta, the power
phi     attenuation        (N - 1,), (slope / (alpha mean slope))^(beta - 1)
lLd     new line           (N,), the sum of phi G, from where lL begins

The script uses the formula of `tonemap.fattal.attenuation` for each frame of the display. A test
compares the two.
"""

import numpy as np
import traitlets

from hdrlab.core.arrays import ArrayLike, describe
from hdrlab.errors import InputError
from hdrlab.show.pictures import PLOT_PIXEL_DENSITY, Picture, encode, picture_areas, require_alt
from hdrlab.show.plots.curves import lines
from hdrlab.show.widgets.scripts import Widget, script
from hdrlab.tonemap import fattal

MIN_PIXELS = 8
MAX_PIXELS = 400
# Slopes below this multiple of the mean slope are amplified no more than it, as in `tonemap.fattal`.
MIN_RELATIVE_SLOPE = 0.01
ALPHA_RANGE = (0.01, 1.0)
BETA_RANGE = (0.1, 1.0)
# The axis of luminance goes this far beyond the line at both ends, as a fraction of its range.
MARGIN_FRACTION = 0.08


class GradientLine(Widget):
    """A line of pixels and the parameters of its attenuation; `at` is the step that is pointed at."""

    _esm = script("drag.js", "lines.js", "gradients.js")
    line = traitlets.List(traitlets.Float()).tag(sync=True)
    span = traitlets.List(traitlets.Float()).tag(sync=True)  # ends of the axis of the line
    noise = traitlets.Float(MIN_RELATIVE_SLOPE).tag(sync=True)
    alpha_range = traitlets.List(traitlets.Float()).tag(sync=True)
    beta_range = traitlets.List(traitlets.Float()).tag(sync=True)
    alpha = traitlets.Float(1.0).tag(sync=True)
    beta = traitlets.Float(0.8).tag(sync=True)
    at = traitlets.Int(0).tag(sync=True)
    alt = traitlets.Unicode().tag(sync=True)
    picture = traitlets.Bytes().tag(sync=True)  # WebP, with the first parameters
    areas = traitlets.List(traitlets.List(traitlets.Float())).tag(sync=True)  # see picture_areas

    def still(self) -> Picture:
        """Return a plot of the line before and after, with the first parameters."""
        return Picture(
            (self.picture,),
            (self.alt,),
            (f"alpha {self.alpha:g}, beta {self.beta:g}",),
            density=PLOT_PIXEL_DENSITY,
            areas=(self.areas,),
        )


def gradient_line(
    lL: ArrayLike, *, alt: str, alpha: float = 1.0, beta: float = 0.8
) -> GradientLine:
    """Return a widget in which Fattal's attenuation of gradients is dragged, for one line of pixels.

    The steps from pixel to pixel are bars. Their attenuated heights are added up again to a new
    line, which is drawn over the first one.

    Parameters
    ----------
    lL : (N,)
        ln of luminance, 8 to 400 pixels.
    alt : str
        What the line shows.
    alpha : float
        The slope that does not change at first, as a multiple of the mean slope, 0.01 to 1.
    beta : float
        The power of the attenuation at first, 0.1 to 1; with 1 nothing changes.

    Raises
    ------
    InputError
        For a line that is not finite, does not have 8 to 400 pixels or is constant, parameters out
        of range, or an empty alt text.

    Examples
    --------
    >>> ramp = np.linspace(0, 5, 40) ** 2
    >>> figure = gradient_line(ramp, alt="A bent ramp", beta=0.5)
    >>> figure.at  # the largest step
    38
    """
    lL = np.asarray(lL, np.float64)
    if lL.ndim != 1 or not MIN_PIXELS <= lL.size <= MAX_PIXELS or not np.isfinite(lL).all():
        raise InputError(
            f"expected a finite line of {MIN_PIXELS} to {MAX_PIXELS} pixels, got {describe(lL)}"
        )
    for name, value, (least, most) in (("alpha", alpha, ALPHA_RANGE), ("beta", beta, BETA_RANGE)):
        if not least <= value <= most:
            raise InputError(f"expected {name} from {least} to {most}, got {value}")
    G = np.diff(lL)
    slope = np.abs(G)
    if not slope.any():
        raise InputError("expected a line with different values, got only equal ones")
    phi = fattal.attenuation(
        slope, float(slope.mean()), alpha=alpha, beta=beta, noise=MIN_RELATIVE_SLOPE
    )
    lLd = lL[0] + np.append(0, np.cumsum(phi * G))
    margin = MARGIN_FRACTION * np.ptp(lL)
    span = (float(lL.min() - margin), float(lL.max() + margin))
    plot = lines(
        np.arange(lL.size),
        {"before": lL, "after: attenuated steps, added up": lLd},
        across="place, pixels",
        up="ln of luminance, nats",
        limits=span,
    )
    return GradientLine(
        line=lL.tolist(),
        span=list(span),
        alpha_range=list(ALPHA_RANGE),
        beta_range=list(BETA_RANGE),
        alpha=alpha,
        beta=beta,
        at=int(np.argmax(slope)),
        alt=require_alt(alt),
        picture=encode(plot, PLOT_PIXEL_DENSITY),
        areas=picture_areas(plot),
    )
