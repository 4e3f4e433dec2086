"""Figures of notebooks and pages, each with alt text for readers who cannot see it.

drawn  the result of a draw function: a uint8 image (H, W) or (H, W, 3), an Axes or a Figure
alt    alt text: what the figure shows, in one sentence
"""

import sys
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import jinja2
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg

from hdrlab.core.arrays import ArrayLike, NDArray, describe
from hdrlab.errors import InputError
from hdrlab.io import web
from hdrlab.show.pages.templates import templates
from hdrlab.show.plots import figures, reuse

MAX_MAP_PIXELS = 1000  # along the longer side of a radiance map in false color
PLOT_PIXEL_DENSITY = 2  # pixels of a plot per CSS pixel, for high-density screens
PAGE_COLUMN_PIXELS = 640  # a smaller image is stretched to this width
# below this fraction of changed pixels a photo is stored as a lossless difference
MAX_CHANGED_FRACTION = 1 / 8
# a plot has at least this fraction of white pixels, over all and at its edges
MIN_WHITE_FRACTION = 0.72
MIN_WHITE_EDGE_FRACTION = 0.93
DECADES_PER_STOP = float(np.log10(2))
PARAMETER_SYMBOLS = dict(
    alpha="α",
    beta="β",
    delta="δ",
    epsilon="ε",
    rho="ρ",
    s2="s₂",
    sigma="σ",
    sigma_r="σᵣ",
    sigma_s="σₛ",
)


class Picture(NamedTuple):
    """Images side by side, as a notebook and its exported page show them.

    Attributes
    ----------
    frames : the encoded images
    alts, captions : one of each per image
    scales : color scales below the images, in stops and in decades
    density : pixels of an image per CSS pixel
    areas : boxes of each image that keep their colors on a dark page, see `picture_areas`
    folded : whether the images stay behind the words "Side by side" until a reader unfolds them
    """

    frames: tuple[bytes, ...]
    alts: tuple[str, ...]
    captions: tuple[str, ...]
    scales: tuple[figures.Scale, ...] = ()
    density: int = 1
    areas: tuple[list[list[float]], ...] = ()
    folded: bool = False

    def __repr__(self) -> str:
        return "; ".join(self.alts)

    def _repr_html_(self) -> str:
        figures_on_page = []
        for index, frame in enumerate(self.frames):
            image = web.decode_picture(frame)
            figures_on_page.append(
                {
                    "src": web.data_uri(frame),
                    "alt": self.alts[index],
                    "caption": self.captions[index],
                    "image": image,
                    "ink": is_ink(image),
                    "areas": self.areas[index] if self.areas else [],
                }
            )
        return _template().render(
            figures=figures_on_page,
            scales=self.scales,
            density=self.density,
            column=PAGE_COLUMN_PIXELS,
            folded=self.folded,
        )


@cache
def _template() -> jinja2.Template:
    return templates(Path(__file__).parent).get_template("picture.html")


def picture(drawn: object, *, alt: str, caption: str = "") -> Picture:
    """Return `drawn` as a Picture, for the last line of a notebook's cell."""
    return Picture(
        frames=(encode(drawn, PLOT_PIXEL_DENSITY),),
        alts=(require_alt(alt),),
        captions=(caption,),
        density=_density(drawn),
        areas=(picture_areas(drawn),),
    )


def radiance(E: ArrayLike, *, alt: str) -> Picture:
    """Return a radiance map in false colour above a legend in stops and decades; all but 0.1 % of it fits.

    Parameters
    ----------
    E : (H, W) or (H, W, 3)
        Radiance; a map larger than 1000 pixels is shown by means of k x k pixels.
    alt : str
        What the map shows; the range of its luminance is added.

    Raises
    ------
    ValueError
        For a map without light, or an empty alt text.

    Examples
    --------
    >>> E = np.geomspace(1, 2.0**12, 100)[None] * np.ones((20, 1))
    >>> radiance(E, alt="A wedge, ever brighter")
    A wedge, ever brighter, 12.0 stops from the darkest to the brightest
    """
    ev = figures.stops(E)
    low, high = figures.limits(ev)
    frame = encode(figures.false_colour(figures.fit(ev, MAX_MAP_PIXELS), low, high))
    dynamic_range = np.nanmax(ev) - np.nanmin(ev)
    alt = f"{require_alt(alt)}, {dynamic_range:.1f} stops from the darkest to the brightest"
    return Picture((frame,), (alt,), ("",), _scales(low, high))


def strip(
    f: Callable[..., Any],
    draw: Callable[[Any], object],
    /,
    *,
    alt: str,
    caption: str = "",
    **values: Iterable[Any],
) -> Picture:
    """Return draw(f(name=value)) for several values of one parameter, side by side, as a printed slider.

    Parameters
    ----------
    f : function
        Computes a result; its other parameters keep their defaults.
    draw : function
        Takes what `f` returns, and returns a uint8 picture, an Axes or a Figure.
    alt : str
        What the pictures show; each one's caption is added to it.
    caption : str, optional
        The caption of a value as a format string, such as "{:g} pixels wide". By default, the
        parameter's name and the value.
    **values : iterable
        One parameter of `f` and the values to show it at.

    Raises
    ------
    ValueError
        For no or several parameters, no values, an empty alt text, or a `draw` that returns
        something else.

    Examples
    --------
    >>> def square(level):
    ...     return np.full((8, 8), level, np.uint8)
    >>> strip(square, lambda picture: picture, alt="A gray square", level=[0, 128])
    A gray square, level 0; A gray square, level 128
    >>> strip(square, lambda picture: picture, alt="A square", caption="{:.0%} gray", level=[0, 1])
    A square, 0% gray; A square, 100% gray
    """
    if len(values) != 1:
        raise InputError(
            f"expected one parameter with its values, got {len(values)}: {', '.join(values)}"
        )
    [name] = values
    frames = []
    densities = []
    areas = []
    captions = []
    for value in values[name]:
        drawn = draw(f(**{name: value}))
        frames.append(encode(drawn, PLOT_PIXEL_DENSITY))
        densities.append(_density(drawn))
        areas.append(picture_areas(drawn))
        captions.append(caption.format(value) if caption else in_words(name, value))
    if not frames:
        raise InputError(f"expected at least one value for {name}, got none")
    return Picture(
        frames=tuple(frames),
        alts=tuple(f"{require_alt(alt)}, {caption}" for caption in captions),
        captions=tuple(captions),
        density=max(densities),
        areas=tuple(areas),
    )


def side_by_side(
    f: Callable[..., Any],
    draw: Callable[[Any], object],
    /,
    *,
    alt: str,
    caption: str = "",
    **values: Iterable[Any],
) -> Picture:
    """Return a `strip` behind the words "Side by side", for the cell after a slider that shows the same.

    A reader unfolds it to compare values. On paper, and on a page without scripts, where no slider
    moves, it is open. Parameters and errors are those of `strip`.
    """
    return strip(f, draw, alt=alt, caption=caption, **values)._replace(folded=True)


def encode(drawn: object, density: int = 1) -> bytes:
    """Encode the result of a draw function as WebP: plots without loss, photos with loss.

    A plot is also stored with loss where that takes less than half of the bytes, as for a map of
    many colored squares.
    """
    image = render(drawn, density)
    is_plot = not isinstance(drawn, np.ndarray)
    if not is_plot:
        return web.encode_webp(image, quality=80)
    lossy = web.encode_webp(image, quality=50)
    if not _is_drawing(image):
        return lossy
    lossless = web.encode_webp(image, lossless=True)
    return lossless if len(lossless) < 2 * len(lossy) else lossy


def _density(drawn: object) -> int:
    return 1 if isinstance(drawn, np.ndarray) else PLOT_PIXEL_DENSITY


def encode_change(image: web.Image, first: web.Image | None = None) -> bytes:
    """Encode `image` as WebP that is painted over the image `first`.

    A drawing, or a photo of which little changed, becomes a lossless image of the changed pixels,
    transparent elsewhere. Other photos are stored whole, with loss.

    Examples
    --------
    >>> page = np.full((200, 300), 255, np.uint8)
    >>> len(encode_change(page, page)) < 100
    True
    """
    pixels = web.as_rgb(image)
    is_lossless = _is_drawing(image)
    if first is not None and first.shape == image.shape:
        changed = (pixels != web.as_rgb(first)).any(axis=-1)
        pixels = np.dstack([pixels, np.uint8(255) * changed])
        is_lossless = is_lossless or changed.mean() < MAX_CHANGED_FRACTION
    if is_lossless:
        return web.encode_webp(pixels, lossless=True)
    return web.encode_webp(image, quality=75)


def _is_drawing(image: web.Image) -> bool:
    """Return whether an image is a drawing: its rows are a few runs of one color each."""
    return (
        len(web.encode_runs(image)) <= web.MAX_RUN_BYTES_PER_PIXEL * image.shape[0] * image.shape[1]
    )


def is_ink(image: web.Image) -> bool:
    """Return whether an image is lines on white paper, which a dark page may invert.

    Photos and maps keep their colors.
    """
    white = (image == 255).all(axis=-1)
    edges = np.concatenate([white[[0, -1]].ravel(), white[:, [0, -1]].ravel()])
    return bool(white.mean() > MIN_WHITE_FRACTION and edges.mean() > MIN_WHITE_EDGE_FRACTION)


def render(drawn: object, density: int = 1) -> NDArray[np.uint8]:
    """Render the result of a draw function as an image (H, W) or (H, W, 3) uint8.

    A plot has `density` times as many pixels along a side. Raises InputError for other types.
    """
    figure = getattr(drawn, "figure", None)
    if hasattr(figure, "savefig"):
        return _pixels(figure, density)
    if not isinstance(drawn, np.ndarray):
        raise InputError(
            "expected draw to return a uint8 image (H, W[, 3]), an Axes or a Figure, "
            f"got {type(drawn).__name__}"
        )
    has_image_shape = drawn.ndim == 2 or drawn.shape[2:] == (3,)
    if drawn.dtype != np.uint8 or drawn.size == 0 or not has_image_shape:
        raise InputError(
            "expected draw to return a uint8 image (H, W[, 3]), an Axes or a Figure, "
            f"got an array of {describe(drawn)}"
        )
    return drawn


def picture_areas(drawn: object) -> list[list[float]]:
    """Return the boxes of a figure that keep their colors on a dark page.

    Each box is left, top, width and height as fractions of the figure: the Axes that show images,
    or the first Axes where none does. An image has no boxes.
    """
    axes = getattr(getattr(drawn, "figure", None), "axes", [])
    with_images = [ax for ax in axes if ax.images]
    boxes = [ax.get_position() for ax in with_images or axes[:1]]
    return [[box.x0, 1 - box.y1, box.width, box.height] for box in boxes]


def require_alt(alt: str) -> str:
    """Return the alt text; raise InputError if it is empty."""
    if not isinstance(alt, str) or not alt.strip():
        raise InputError(f"expected an alt text that says what the picture shows, got {alt!r}")
    return alt


def short(value: object) -> str:
    """Return a value as the text beside a slider, numbers with four digits."""
    return f"{value:.4g}" if isinstance(value, float | np.floating) else str(value)


def in_words(name: str, value: object) -> str:
    """Return a parameter's value as a caption.

    Examples
    --------
    >>> [in_words("samples", 3), in_words("read_noise", 5.0), in_words("q", 0.5), in_words("weight", "hat")]
    ['3 samples', 'read noise 5', 'q = 0.5', 'hat']
    >>> [in_words("alpha", 2), in_words("sigma_r", 0.05)]
    ['α = 2', 'σᵣ = 0.05']
    """
    words = name.replace("_", " ")
    text = short(value)
    if isinstance(value, str):
        return text
    if isinstance(value, bool):
        return f"with {words}" if value else f"without {words}"
    symbol = PARAMETER_SYMBOLS.get(name, name if len(name) <= 2 else "")
    if symbol:
        return f"{symbol} = {text}"
    is_plural = name.endswith("s") and not name.endswith(("ss", "us"))
    if not is_plural:
        return f"{words} {text}"
    return f"1 {words[:-1]}" if text == "1" else f"{text} {words}"


def _pixels(figure: Any, density: int) -> NDArray[np.uint8]:
    dpi = figure.dpi
    figure.set_dpi(density * dpi)
    # a canvas that is used again remembers the widths of its texts
    has_agg_canvas = type(figure.canvas) is FigureCanvasAgg
    canvas = figure.canvas if has_agg_canvas else FigureCanvasAgg(figure)
    reuse.paint(canvas)
    figure.set_dpi(dpi)
    # pyplot would show its figure a second time below the cell
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close(figure)
    return np.array(canvas.buffer_rgba())[..., :3]


def _scales(low: int, high: int) -> tuple[figures.Scale, figures.Scale]:
    """Return the color scale in stops and the one in decades."""
    low_decade = low * DECADES_PER_STOP
    high_decade = high * DECADES_PER_STOP
    decade_digits = 1 if high_decade - low_decade <= 3 else 0
    stop_digits = 1 if high - low < 4 else 0
    stops = figures.scale(low, high, digits=stop_digits)
    return stops, figures.scale(low_decade, high_decade, digits=decade_digits)
