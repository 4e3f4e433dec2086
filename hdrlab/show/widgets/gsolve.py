"""Recovering the response curve by hand, as a figure: slide pixels sideways until they lie on one curve.

Z   pixel levels       (N, P), sample i in photo j, 0 ... 255
B   ln exposure times  (P,)
w   weights            (256,), the hat
g   response           (256,), ln exposure of each level
lE  ln irradiance      (N,), how far each sample is moved to the right

For the lE under the reader's hand, the script finds the g that minimizes the sum of squares of
`response.debevec`. A test compares both. At its least, lE is that of `gsolve`.
"""

import numpy as np
import traitlets

from hdrlab.core import arrays
from hdrlab.core.arrays import F64, Array, ArrayLike, as_stack, as_times
from hdrlab.core.weights import hat
from hdrlab.errors import InputError
from hdrlab.io import web
from hdrlab.response.debevec import gsolve
from hdrlab.show import plots
from hdrlab.show.pictures import PLOT_PIXEL_DENSITY, Picture, encode, picture_areas, require_alt
from hdrlab.show.plots.figures import fit
from hdrlab.show.widgets.scripts import Widget, script

MAX_PHOTO_SIDE = 480
SMOOTHNESS_VALUES = (0.1, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0)
DEFAULT_SMOOTHNESS_INDEX = 4
MAX_PIXELS = 6
# The exposure axis goes this far beyond the points at both ends.
MARGIN_LN = 1.0


class GsolveByHand(Widget):
    """Levels of a few pixels in all photos; `ln_E` is how far the reader has moved each of them."""

    _esm = script("drag.js", "gsolve.js")
    levels = traitlets.List(traitlets.List(traitlets.Int())).tag(sync=True)  # (N, P)
    places = traitlets.List(traitlets.List(traitlets.Float())).tag(sync=True)  # (down, right)
    shutters = traitlets.List(traitlets.Unicode()).tag(sync=True)
    ln_times = traitlets.List(traitlets.Float()).tag(sync=True)
    weights = traitlets.List(traitlets.Float()).tag(sync=True)
    smoothness_values = traitlets.List(traitlets.Float()).tag(sync=True)
    smoothness_index = traitlets.Int(DEFAULT_SMOOTHNESS_INDEX).tag(sync=True)
    solutions = traitlets.List(traitlets.List(traitlets.Float())).tag(sync=True)  # lE of each
    ln_E = traitlets.List(traitlets.Float()).tag(sync=True)
    span = traitlets.List(traitlets.Float()).tag(sync=True)  # ends of the exposure axis
    alt = traitlets.Unicode().tag(sync=True)
    photo = traitlets.Bytes().tag(sync=True)  # WebP
    picture = traitlets.Bytes().tag(sync=True)  # WebP, the points on the curve
    areas = traitlets.List(traitlets.List(traitlets.Float())).tag(sync=True)  # see picture_areas

    def still(self) -> Picture:
        """Return a plot of the points on the curve that gsolve finds."""
        return Picture(
            (self.picture,), (self.alt,), ("",), density=PLOT_PIXEL_DENSITY, areas=(self.areas,)
        )


def gsolve_by_hand(
    images: ArrayLike, times: ArrayLike, *, alt: str, pixels: int = 4
) -> GsolveByHand:
    """Return a widget in which the levels of a few pixels are dragged sideways onto one curve.

    The smooth curve follows the points, and the sum of squares that `gsolve` minimizes is shown.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8
        Aligned photos. The levels of the green channel are shown.
    times : (P,) float
        Exposure times in seconds.
    alt : str
        What the photos show.
    pixels : int
        The number of pixels, 2 to 6. They lie at even ranks of brightness, from dark to bright.

    Raises
    ------
    InputError
        For photos that are not 8 bits, times that do not fit, another number of pixels, an empty
        alt text, or pixels that are not well exposed in two photos.

    Examples
    --------
    >>> ramp = np.linspace(1, 100, 10_000).reshape(100, 100)  # a linear camera
    >>> images = np.clip(np.round(ramp * np.array([1, 2, 4])[:, None, None]), 0, 255).astype(np.uint8)
    >>> widget = gsolve_by_hand(images, [0.01, 0.02, 0.04], alt="A ramp")
    >>> widget.ln_E
    [0.0, 0.0, 0.0, 0.0]
    """
    stack = as_stack(images)
    if stack.dtype != np.uint8:
        raise InputError(f"expected photos of 8 bits, got {arrays.describe(stack)}")
    if not 2 <= pixels <= MAX_PIXELS:
        raise InputError(f"expected 2 to {MAX_PIXELS} pixels, got {pixels}")
    B = np.log(as_times(times, len(stack), distinct=2))
    levels = stack[..., 1] if stack.ndim == 4 else stack
    y, x = _find_places(levels, pixels)
    Z = levels[:, y, x].T.astype(np.intp)
    w = hat()
    found = [gsolve(Z, B, smoothness, w) for smoothness in SMOOTHNESS_VALUES]
    span = _find_span(B, found[DEFAULT_SMOOTHNESS_INDEX].lE)
    g, lE = found[DEFAULT_SMOOTHNESS_INDEX]
    plot = plots.samples(Z, lE, B, g=g, span=span)
    height, width = levels.shape[1:]
    return GsolveByHand(
        levels=Z.tolist(),
        places=np.stack([(y + 0.5) / height, (x + 0.5) / width], axis=-1).tolist(),
        shutters=[plots.seconds(time) for time in np.exp(B)],
        ln_times=B.tolist(),
        weights=w.tolist(),
        smoothness_values=list(SMOOTHNESS_VALUES),
        solutions=[solution.lE.tolist() for solution in found],
        ln_E=[0.0] * pixels,
        span=list(span),
        alt=require_alt(alt),
        photo=web.encode_webp(fit(stack[len(stack) // 2], MAX_PHOTO_SIDE)),
        picture=encode(plot, PLOT_PIXEL_DENSITY),
        areas=picture_areas(plot),
    )


def _find_places(levels: Array, count: int) -> tuple[Array, Array]:
    """Return rows and columns of pixels at the ranks (k + 1/2) / count of the sum of all photos."""
    brightness = levels.sum(axis=0, dtype=np.int64)
    order = np.argsort(brightness, axis=None, kind="stable")
    ranks = ((np.arange(count) + 0.5) / count * order.size).astype(int)
    y, x = np.unravel_index(order[ranks], brightness.shape)
    return y, x


def _find_span(B: F64, lE: F64) -> tuple[float, float]:
    """Return the ends of an exposure axis that shows the points before and after they are moved."""
    low = B.min() + min(lE.min(), 0.0) - MARGIN_LN
    high = B.max() + max(lE.max(), 0.0) + MARGIN_LN
    return float(low), float(high)
