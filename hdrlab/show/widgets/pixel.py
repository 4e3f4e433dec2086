"""The weighted mean of a radiance map at one pixel, as a figure: press the photo, and read each claim.

Z  pixel levels   (P, H, W[, C]) uint8
g  ln exposure of each level (256,) or (256, C); w  weights (256,)
E  radiance: exp of the weighted mean of g(Z) - ln t

The script uses the formulas of `radiance.merge` for the pressed pixel. A test compares the two.
"""

import zlib

import numpy as np
import traitlets

from hdrlab.core import arrays
from hdrlab.core.arrays import Array, ArrayLike
from hdrlab.core.weights import hat
from hdrlab.errors import InputError
from hdrlab.radiance.merge import CLIPPING_LEVEL, merge
from hdrlab.show.pictures import PLOT_PIXEL_DENSITY, Picture, encode, picture_areas, require_alt
from hdrlab.show.plots import seconds
from hdrlab.show.plots.lectures import merging
from hdrlab.show.widgets.scripts import Widget, script

# Larger photos are reduced to every k-th pixel: a mean of levels would be no level.
MAX_PHOTO_SIDE = 200
N_LEVELS = 256
# The axis of radiance leaves out the most extreme claims at both ends, which are single pixels.
AXIS_QUANTILES = (0.002, 0.998)


class PixelMean(Widget):
    """Photos, a response and weights; `at` is the pixel (y, x) whose claims are shown."""

    _esm = script("drag.js", "pixel.js")
    levels = traitlets.Bytes().tag(sync=True)  # deflated differences, (P, C, H, W)
    shape = traitlets.List(traitlets.Int()).tag(sync=True)  # (P, H, W, C)
    shutters = traitlets.List(traitlets.Unicode()).tag(sync=True)
    ln_times = traitlets.List(traitlets.Float()).tag(sync=True)
    response = traitlets.List(traitlets.Float()).tag(sync=True)
    weights = traitlets.List(traitlets.Float()).tag(sync=True)
    top = traitlets.Int(250).tag(sync=True)  # the first clipped level
    channel = traitlets.Int(0).tag(sync=True)
    span = traitlets.List(traitlets.Float()).tag(sync=True)  # ends of the axis of ln E
    at = traitlets.List(traitlets.Int()).tag(sync=True)
    alt = traitlets.Unicode().tag(sync=True)
    picture = traitlets.Bytes().tag(sync=True)  # WebP, the claims at the first pixel
    areas = traitlets.List(traitlets.List(traitlets.Float())).tag(sync=True)  # see picture_areas

    def still(self) -> Picture:
        """Return a plot of the claims at the first pixel."""
        return Picture(
            (self.picture,), (self.alt,), ("",), density=PLOT_PIXEL_DENSITY, areas=(self.areas,)
        )


def pixel_mean(
    images: ArrayLike,
    times: ArrayLike,
    g: ArrayLike,
    w: ArrayLike | None = None,
    *,
    alt: str,
    at: tuple[float, float] = (0.5, 0.5),
) -> PixelMean:
    """Return a widget that shows what each photo claims about a pressed pixel, and the weighted mean.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8
        Aligned photos. Larger ones than 200 pixels on a side are reduced to every k-th pixel. The
        levels of the green channel are shown.
    times : (P,) float
        Exposure times in seconds.
    g : (256,) or (256, 3)
        Response, ln exposure of each level.
    w : (256,), optional
        Weights, the hat by default.
    alt : str
        What the photos show; the widget adds the pixel.
    at : (down, right)
        The first pixel, as fractions of the height and the width, from 0 to below 1.

    Raises
    ------
    InputError
        For photos, times, response or weights that `merge` rejects, photos that are not 8 bits, an
        empty alt text, or a pixel outside.

    Examples
    --------
    >>> images = np.array([[[40, 90]], [[80, 180]]], np.uint8)  # a linear camera
    >>> g = np.log(np.maximum(np.arange(256), 0.5) / 128)
    >>> pixel_mean(images, [1, 2], g, alt="Two pixels").shutters
    ['1 s', '2 s']
    """
    images = np.asarray(images)
    if images.dtype != np.uint8:
        raise InputError(f"expected photos of 8 bits, got {arrays.describe(images)}")
    if not all(0 <= fraction < 1 for fraction in at):
        raise InputError(f"expected a pixel at two fractions from 0 to below 1, got {at}")
    E = merge(images, times, g, w)
    weights = hat(N_LEVELS) if w is None else np.asarray(w, np.float64)
    B = np.log(np.asarray(times, np.float64))
    step = -(-max(images.shape[1:3]) // MAX_PHOTO_SIDE)
    channels = images.reshape(*images.shape[:3], -1)[:, ::step, ::step]
    n_photos, height, width, n_channels = channels.shape
    channel = n_channels // 2
    response = np.reshape(g, (N_LEVELS, -1))[:, -1 if np.size(g) == N_LEVELS else channel]
    y = int(at[0] * height)
    x = int(at[1] * width)
    lE = np.log(E.reshape(*E.shape[:2], -1)[::step, ::step, channel])
    top = int(CLIPPING_LEVEL * (N_LEVELS - 1)) + 1
    plot = merging.draw_measurements(
        channels[:, y, x, channel], B, response, weights, lE[y, x], middle=float(np.median(lE))
    )
    return PixelMean(
        levels=deflate(np.moveaxis(channels, -1, 1)),
        shape=[n_photos, height, width, n_channels],
        shutters=[seconds(time) for time in np.exp(B)],
        ln_times=B.tolist(),
        response=response.tolist(),
        weights=weights.tolist(),
        top=top,
        channel=channel,
        span=np.quantile(lE, AXIS_QUANTILES).tolist(),
        at=[y, x],
        alt=require_alt(alt),
        picture=encode(plot, PLOT_PIXEL_DENSITY),
        areas=picture_areas(plot),
    )


def deflate(levels: Array) -> bytes:
    """Return uint8 levels (..., W) as deflated differences of neighbors in a row."""
    steps = np.diff(levels, axis=-1, prepend=np.zeros_like(levels[..., :1]))
    return zlib.compress(steps.tobytes())
