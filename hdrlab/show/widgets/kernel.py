"""The bilateral filter on one line of pixels: move the kernel, and see which neighbors count.

v       signal             (N,), such as log luminance along a row
g       weight by place    exp(-(p - q)^2 / (2 sigma_s^2)), sigma_s in pixels
w       weight by value    exp(-(v_q - v_p)^2 / (2 sigma_r^2)), sigma_r in the unit of v
mean    filtered signal    (N,), the sum of g w v_q over that of g w
blur    the same without w

The script uses the formulas of `core.filters.bilateral` for each frame of the display. A test
compares the two.
"""

import numpy as np
import traitlets

from hdrlab.core.arrays import ArrayLike, describe
from hdrlab.core.filters.bilateral import bilateral
from hdrlab.errors import InputError
from hdrlab.show.pictures import PLOT_PIXEL_DENSITY, Picture, encode, picture_areas, require_alt
from hdrlab.show.plots.curves import lines
from hdrlab.show.widgets.scripts import Widget, script

MIN_PIXELS = 8
MAX_PIXELS = 400
# The axis of v goes this far beyond the signal at both ends, as a fraction of its range.
MARGIN_FRACTION = 0.25
# A sigma_r of this many times the range of the signal makes all weights by value equal.
WIDE_SIGMA_R = 1000.0


class BilateralKernel(Widget):
    """A line of pixels; `at` is the pixel in the middle of the kernel, the sigmas are its widths."""

    _esm = script("drag.js", "lines.js", "kernel.js")
    signal = traitlets.List(traitlets.Float()).tag(sync=True)
    span = traitlets.List(traitlets.Float()).tag(sync=True)  # ends of the axis of the signal
    at = traitlets.Int(0).tag(sync=True)
    sigma_s = traitlets.Float(8.0).tag(sync=True)
    sigma_r = traitlets.Float(0.4).tag(sync=True)
    name = traitlets.Unicode().tag(sync=True)
    unit = traitlets.Unicode().tag(sync=True)
    alt = traitlets.Unicode().tag(sync=True)
    picture = traitlets.Bytes().tag(sync=True)  # WebP, with the first widths
    areas = traitlets.List(traitlets.List(traitlets.Float())).tag(sync=True)  # see picture_areas

    def still(self) -> Picture:
        """Return a plot of the signal, its blur and the bilateral filter with the first widths."""
        caption = f"{self.sigma_s:g} pixels wide, {self.sigma_r:g} {self.unit} high"
        return Picture(
            (self.picture,),
            (self.alt,),
            (caption,),
            density=PLOT_PIXEL_DENSITY,
            areas=(self.areas,),
        )


def bilateral_kernel(
    v: ArrayLike,
    *,
    alt: str,
    at: int | None = None,
    sigma_s: float = 8.0,
    sigma_r: float = 0.4,
    name: str = "log10 of luminance",
    unit: str = "decades",
) -> BilateralKernel:
    """Return a widget in which the kernel of the bilateral filter is dragged along a line of pixels.

    Each neighbor's weight is drawn where the neighbor is: by place, by value, and their product.
    The widths of the kernel are dragged too.

    Parameters
    ----------
    v : (N,)
        The signal, 8 to 400 pixels.
    alt : str
        What the line shows.
    at : int, optional
        The pixel in the middle of the kernel at first; by default, that in the middle of the line.
    sigma_s : float
        Width of the kernel in pixels at first.
    sigma_r : float
        Width of the kernel in the unit of v at first.
    name, unit : str
        What v is, and its unit.

    Raises
    ------
    InputError
        For a signal that is not a finite line of 8 to 400 pixels or is constant, a pixel outside
        it, widths that are not positive, or an empty alt text.

    Examples
    --------
    >>> step = np.where(np.arange(40) < 20, 0.0, 2.0)
    >>> bilateral_kernel(step, alt="A step").span
    [-0.5, 2.5]
    """
    v = np.asarray(v, np.float64)
    if v.ndim != 1 or not MIN_PIXELS <= v.size <= MAX_PIXELS:
        raise InputError(
            f"expected a line of {MIN_PIXELS} to {MAX_PIXELS} pixels, got {describe(v)}"
        )
    if at is None:
        at = v.size // 2
    if not 0 <= at < v.size:
        raise InputError(f"expected a pixel from 0 to {v.size - 1}, got {at}")
    base = bilateral(v[None], sigma_s=sigma_s, sigma_r=sigma_r).mean[0]
    low = float(v.min())
    high = float(v.max())
    if low == high:
        raise InputError("expected a line with different values, got only equal ones")
    margin = MARGIN_FRACTION * (high - low)
    blur = bilateral(v[None], sigma_s=sigma_s, sigma_r=WIDE_SIGMA_R * (high - low)).mean[0]
    plot = lines(
        np.arange(v.size),
        {name: v, "Gaussian blur": blur, "bilateral filter": base},
        across="place, pixels",
        up=f"{name}, {unit}",
        limits=(low - margin, high + margin),
    )
    return BilateralKernel(
        signal=v.tolist(),
        span=[low - margin, high + margin],
        at=at,
        sigma_s=sigma_s,
        sigma_r=sigma_r,
        name=name,
        unit=unit,
        alt=require_alt(alt),
        picture=encode(plot, PLOT_PIXEL_DENSITY),
        areas=picture_areas(plot),
    )
