"""Images and plots for HTML pages, with color scales as text, in colors for color-blind readers.

ev    radiance in stops   (H, W), log2 of luminance over its median; NaN without light
quality  (H, W) uint8     flags of `radiance.merge.Quality`

The plots of `show.plots` have their scale inside the image. On a page the scale is text below it,
which stays legible on a phone and which a screen reader can read.
"""

import io
from dataclasses import dataclass
from typing import Any, cast

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from hdrlab.core.arrays import Array, ArrayLike, NDArray
from hdrlab.core.colour import luminance
from hdrlab.errors import InputError
from hdrlab.io import web
from hdrlab.radiance.merge import Quality
from hdrlab.show.pages.wording import signed

Image = NDArray[np.uint8]
MISSING_COLOR = "#808080"
REGION_COLOR = (230, 126, 0)
REGION_OUTLINE_COLOR = (60, 20, 0)
CSS_PIXELS_PER_INCH = 96
# The range of a map leaves out the outermost 0.1 % of the pixels at both ends.
RANGE_PERCENTILES = (0.1, 99.9)
COLORS_PER_SCALE = 17
# Colors of pixels that were not measured, from dark to light, so that they differ in gray too.
FLAG_COLORS = {
    Quality.DARK: "#14148C",
    Quality.UNSEEN: "#404040",
    Quality.STUCK: "#D6007F",
    Quality.CLIPPED | Quality.DARK: "#F0A400",
    Quality.CLIPPED: "#FFF06A",
}


def fit(array: Array, side: int) -> Array:
    """Return the means of k x k pixels, with the smallest k for which no side is above `side`."""
    height, width = array.shape[:2]
    k = -(-max(height, width) // side)
    if k == 1:
        return array
    block_height = min(k, height)
    block_width = min(k, width)
    rows = height // block_height
    columns = width // block_width
    whole = array[: rows * block_height, : columns * block_width]
    blocks = whole.reshape(rows, block_height, columns, block_width, *array.shape[2:])
    return blocks.mean(axis=(1, 3)).astype(array.dtype)


def stops(E: ArrayLike) -> Array:
    """Return ev = log2(L / median L), NaN where L is 0."""
    L = luminance(E)
    has_light = L > 0
    if not np.any(has_light):
        raise InputError("expected radiance with some light in it, got only zeros")
    return np.log2(np.where(has_light, L, np.nan) / np.median(L[has_light]))


def limits(ev: Array) -> tuple[int, int]:
    """Return whole stops as the ends of a scale for all but the outermost pixels."""
    low, high = np.nanpercentile(ev, RANGE_PERCENTILES)
    lower = int(np.floor(low))
    upper = int(np.ceil(high))
    return lower, max(upper, lower + 1)


def false_colour(values: Array, low: float, high: float, *, colours: str = "viridis") -> Image:
    """Return values (H, W) as an image (H, W, 3) in false color from `low` to `high`; NaN is gray."""
    table = matplotlib.colormaps[colours].with_extremes(bad=MISSING_COLOR)
    position = np.ma.masked_invalid((values - low) / (high - low))
    return table(np.clip(position, 0, 1), bytes=True)[..., :3]


def _grow(labels: NDArray[Any], size: int) -> NDArray[Any]:
    """Return the largest label around each pixel, in a square of this size."""
    from scipy.ndimage import maximum_filter  # large, and the other figures do without it

    return np.asarray(maximum_filter(labels, size=size))


def known(picture: Image, quality: NDArray[np.uint8]) -> Image:
    """Return the picture in pale gray, with a dot in its flag's color for each unmeasured pixel."""
    image = _pale_gray(picture).astype(np.uint8)
    for flag, color in FLAG_COLORS.items():
        spots = _grow(quality == flag, size=dot(quality.shape))
        image[spots] = tuple(bytes.fromhex(color[1:]))
    return image


def regions(picture: Image, labels: NDArray[np.int32]) -> Image:
    """Return the picture in pale gray, regions (labels > 0) in orange, each with a dark outline."""
    image = _pale_gray(picture)
    is_inside = labels > 0
    image[is_inside] = 0.5 * image[is_inside] + 0.5 * np.array(REGION_COLOR)
    is_outline = _grow(labels, size=dot(labels.shape)) != labels
    image[is_outline] = REGION_OUTLINE_COLOR
    return image.astype(np.uint8)


def _pale_gray(picture: Image) -> Array:
    """Return a picture as an image (H, W, 3) of pale grays, on which marks stand out."""
    gray = picture if picture.ndim == 2 else picture.mean(axis=-1)
    return np.repeat((120 + gray * 0.4)[..., None], 3, axis=-1)


def dot(shape: tuple[int, ...]) -> int:
    """Return the odd width in pixels of a dot that is visible in a picture of this shape on a page."""
    return 2 * (max(shape) // 500) + 3


@dataclass(frozen=True)
class Illustration:
    """An embedded image of a page: its data URI, alt text, and size in CSS pixels."""

    src: str
    alt: str
    width: int
    height: int


def photograph(image: Image, side: int, alt: str) -> Illustration:
    """Return an image (H, W[, 3]), reduced to at most `side` pixels on its longer side."""
    small = fit(image, side)
    height, width = small.shape[:2]
    src = web.data_uri(web.encode_webp(small))
    return Illustration(src=src, alt=alt, width=width, height=height)


def plot(ax: Axes, alt: str) -> Illustration:
    """Return the figure of the Axes as SVG. The same drawing gives the same bytes."""
    figure = cast(Figure, ax.get_figure(root=True))
    file = io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": "hdrlab"}):
        figure.savefig(file, format="svg", metadata={"Date": None})
    width, height = figure.get_size_inches()
    return Illustration(
        src=web.data_uri(file.getvalue(), "svg+xml"),
        alt=alt,
        width=round(CSS_PIXELS_PER_INCH * width),
        height=round(CSS_PIXELS_PER_INCH * height),
    )


@dataclass(frozen=True)
class Scale:
    """A color scale: colors #RRGGBB from low to high, and ticks (percent of its length, label)."""

    colours: list[str]
    ticks: list[tuple[float, str]]


def scale(low: float, high: float, colours: str = "viridis", *, digits: int = 0) -> Scale:
    """Return the scale of `false_colour`, with up to seven round ticks."""
    values = np.array(MaxNLocator(6, steps=[1, 2, 5, 10]).tick_values(low, high))
    is_on_scale = (values >= low - 1e-9) & (values <= high + 1e-9)
    ticks = [
        (100 * (value - low) / (high - low), signed(value, digits))
        for value in values[is_on_scale].tolist()
    ]
    table = matplotlib.colormaps[colours](np.linspace(0, 1, COLORS_PER_SCALE))
    return Scale(colours=[to_hex(color) for color in table], ticks=ticks)


def round_up(value: float) -> float:
    """Return the next 1, 2 or 5 times a power of ten, at least 0.01."""
    power = 10.0 ** np.floor(np.log10(max(value, 0.01)))
    return float(next(step * power for step in (1, 2, 5, 10) if step * power >= value))
