"""Maps and plots for a page that writes its own scales, in colours that colour-blind readers tell apart.

ev    radiance in stops   (H, W), log2 of luminance over its median; NaN without light
quality  (H, W) uint8     how each pixel is known, flags of `radiance.merge.Quality`

The plots of `show.plots` carry their scale inside the picture. On a page the scale is text beside
it, which stays legible on a telephone and which a screen reader can read.
"""

import io
from typing import NamedTuple, cast

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from scipy.ndimage import maximum_filter

from hdrlab.core.arrays import Array, ArrayLike, NDArray
from hdrlab.core.colour import luminance
from hdrlab.errors import InputError
from hdrlab.io import web
from hdrlab.radiance.merge import Quality
from hdrlab.show.pages.wording import signed

Image = NDArray[np.uint8]
MISSING = "#808080"
# of a region, and its edge
ORANGE = (230, 126, 0)
OUTLINE = (60, 20, 0)
# What was not measured, from dark to light, so that the kinds part in gray too.
KNOWN = {
    Quality.DARK: "#14148C",
    Quality.UNSEEN: "#404040",
    Quality.STUCK: "#D6007F",
    Quality.CLIPPED | Quality.DARK: "#F0A400",
    Quality.CLIPPED: "#FFF06A",
}


def fit(array: Array, side: int) -> Array:
    """Return the means of k x k pixels, with the least k that brings both sides to `side` or below."""
    k = -(-max(array.shape[:2]) // side)
    if k == 1:
        return array
    down, across = (min(k, length) for length in array.shape[:2])
    h = array.shape[0] // down
    w = array.shape[1] // across
    blocks = array[: h * down, : w * across].reshape(h, down, w, across, *array.shape[2:])
    return blocks.mean(axis=(1, 3)).astype(array.dtype)


def stops(E: ArrayLike) -> Array:
    """Return ev = log2(L / median L)."""
    L = luminance(E)
    if not np.any(L > 0):
        raise InputError("expected radiance with some light in it, got zeros")
    return np.log2(np.where(L > 0, L, np.nan) / np.median(L[L > 0]))


def limits(ev: Array) -> tuple[int, int]:
    """Return the whole stops between which all but the outermost 0.1 % of the pixels lie."""
    low, high = np.nanpercentile(ev, [0.1, 99.9])
    return int(np.floor(low)), max(int(np.ceil(high)), int(np.floor(low)) + 1)


def false_colour(values: Array, low: float, high: float, *, colours: str = "viridis") -> Image:
    """Return values (H, W) as a picture (H, W, 3) whose colours run from `low` to `high`; NaN is gray."""
    table = matplotlib.colormaps[colours].with_extremes(bad=MISSING)
    position = np.ma.masked_invalid((values - low) / (high - low))
    return table(np.clip(position, 0, 1), bytes=True)[..., :3]


def known(picture: Image, quality: NDArray[np.uint8]) -> Image:
    """Return the picture in pale gray, with a dot of its kind's colour where a pixel was not measured."""
    gray = picture if picture.ndim == 2 else picture.mean(axis=-1)
    shown = np.repeat((120 + gray * 0.4).astype(np.uint8)[..., None], 3, axis=-1)
    for flag, colour in KNOWN.items():
        spots = maximum_filter(quality == flag, size=dot(quality.shape))
        shown[spots] = tuple(bytes.fromhex(colour[1:]))
    return shown


def regions(picture: Image, labels: NDArray[np.int32]) -> Image:
    """Return the picture in pale gray, regions (labels > 0) in orange, each with a dark outline."""
    gray = picture if picture.ndim == 2 else picture.mean(axis=-1)
    shown = np.repeat((120 + gray * 0.4)[..., None], 3, axis=-1)
    inside = labels > 0
    shown[inside] = 0.5 * shown[inside] + 0.5 * np.array(ORANGE)
    shown[maximum_filter(labels, size=dot(labels.shape)) != labels] = OUTLINE
    return shown.astype(np.uint8)


def dot(shape: tuple[int, ...]) -> int:
    """Return how wide a dot must be to be found in a picture of this shape on a page, pixels: odd."""
    return 2 * (max(shape) // 500) + 3


class Illustration(NamedTuple):
    """A picture inside the page: its address, what it shows in words, and its size in pixels of the page."""

    src: str
    alt: str
    width: int
    height: int


def photograph(image: Image, side: int, alt: str) -> Illustration:
    """Return a picture (H, W[, 3]), brought to at most `side` pixels."""
    small = fit(image, side)
    return Illustration(web.data_uri(web.encode_webp(small)), alt, small.shape[1], small.shape[0])


def plot(ax: Axes, alt: str) -> Illustration:
    """Return the figure of these Axes as SVG: sharp at every size; the same lines give the same bytes."""
    figure = cast(Figure, ax.get_figure(root=True))
    file = io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": "hdrlab"}):
        figure.savefig(file, format="svg", metadata={"Date": None})
    width, height = (round(96 * inches) for inches in figure.get_size_inches())
    return Illustration(web.data_uri(file.getvalue(), "svg+xml"), alt, width, height)


class Scale(NamedTuple):
    """The colours from the low end to the high one, #RRGGBB, and ticks as (percent of the way, label)."""

    colours: list[str]
    ticks: list[tuple[float, str]]


def scale(low: float, high: float, colours: str = "viridis", *, digits: int = 0) -> Scale:
    """Return the Scale of `false_colour`, with up to seven round ticks."""
    at = np.array(MaxNLocator(6, steps=[1, 2, 5, 10]).tick_values(low, high))
    at = at[(at >= low - 1e-9) & (at <= high + 1e-9)]
    table = matplotlib.colormaps[colours](np.linspace(0, 1, 17))
    ticks = [(100 * (one - low) / (high - low), signed(one, digits)) for one in at.tolist()]
    return Scale([to_hex(one) for one in table], ticks)


def round_up(value: float) -> float:
    """Return the next 1, 2 or 5 times a power of ten, at least 0.01."""
    power = 10.0 ** np.floor(np.log10(max(value, 0.01)))
    return float(next(step * power for step in (1, 2, 5, 10) if step * power >= value))
