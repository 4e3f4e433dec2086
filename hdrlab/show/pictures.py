"""Pictures for a page, each with alt text: a reader who cannot see one still learns what it shows.

drawn  what a draw function returns: a uint8 picture (H, W) or (H, W, 3), an Axes or a Figure
alt    alt text: what is in the picture, in a sentence
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

SIDE = 1000  # pixels
SHARP = 2  # pixels of a plot along a pixel of the page, which many screens show
COLUMN = 640  # pixels of the page: a smaller picture is shown as wide
FEW_CHANGED = 1 / 8  # of a photograph's pixels: where fewer change, they are kept without loss
# of a plot's pixels, and of those at its edges, how many are white at least
PAPER = 0.72
MARGIN = 0.93
DECADE = float(np.log10(2))  # of a stop
SIGNS = dict(alpha="α", beta="β", delta="δ", epsilon="ε", sigma="σ", sigma_r="σᵣ", sigma_s="σₛ")


class Picture(NamedTuple):
    """Pictures side by side, as a notebook and its exported page show them; as text, their alt texts."""

    frames: tuple[bytes, ...]
    alts: tuple[str, ...]
    captions: tuple[str, ...]
    # of the colours, below the pictures: in stops and in decades
    scales: tuple[figures.Scale, ...] = ()
    density: int = 1  # pixels of a frame along a pixel of the page
    areas: tuple[list[list[float]], ...] = ()  # of each frame, what `pictured` says

    def __repr__(self) -> str:
        return "; ".join(self.alts)

    def _repr_html_(self) -> str:
        images = [web.decode_picture(one) for one in self.frames]
        areas: Iterable[list[list[float]]] = self.areas or [[] for _ in images]
        told = (self.alts, self.captions, images, map(is_ink, images), areas)
        each = zip(map(web.data_uri, self.frames), *told, strict=True)
        return _template().render(
            each=list(each), scales=self.scales, density=self.density, column=COLUMN
        )


@cache
def _template() -> jinja2.Template:
    return templates(Path(__file__).parent).get_template("picture.html")


def picture(drawn: object, *, alt: str, caption: str = "") -> Picture:
    """Return `drawn` as a Picture, for the last line of a notebook's cell."""
    frame = encode(drawn, SHARP)
    density = _density(drawn)
    areas = (pictured(drawn),)
    return Picture((frame,), (require_alt(alt),), (caption,), density=density, areas=areas)


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
    frame = encode(figures.false_colour(figures.fit(ev, SIDE), low, high))
    reach = f"{np.nanmax(ev) - np.nanmin(ev):.1f} stops from the darkest to the brightest"
    return Picture((frame,), (f"{require_alt(alt)}, {reach}",), ("",), _scales(low, high))


def strip(
    f: Callable[..., Any], draw: Callable[[Any], object], /, *, alt: str, **values: Iterable[Any]
) -> Picture:
    """Return draw(f(name=value)) for a few values of one parameter, side by side: a slider on paper.

    Parameters
    ----------
    f : function
        Computes a result; its other parameters keep their defaults.
    draw : function
        Takes what `f` returns, and returns a uint8 picture, an Axes or a Figure.
    alt : str
        What the pictures show; each one's value is added to it.
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
    """
    if len(values) != 1:
        raise InputError(
            f"expected one parameter with its values, got {len(values)}: {', '.join(values)}"
        )
    ((name, each),) = values.items()
    each = list(each)
    if not each:
        raise InputError(f"expected at least one value for {name}, got none")
    drawn = (draw(f(**{name: value})) for value in each)
    each_one = ((encode(one, SHARP), _density(one), pictured(one)) for one in drawn)
    frames, densities, areas = zip(*each_one, strict=True)
    captions = tuple(in_words(name, value) for value in each)
    alts = tuple(f"{require_alt(alt)}, {caption}" for caption in captions)
    return Picture(frames, alts, captions, density=max(densities), areas=areas)


def encode(drawn: object, density: int = 1) -> bytes:
    """Return what a draw function returned as WebP: a plot without loss, in small what is like a photo.

    A map, whose pixels are squares of one colour each, is like a photo where that takes half of the
    bytes.
    """
    image = render(drawn, density)
    drawing = not isinstance(drawn, np.ndarray)
    small = web.encode_webp(image, quality=80 - 30 * drawing)
    exact = web.encode_webp(image, lossless=True) if drawing and _is_drawing(image) else b""
    return exact if 0 < len(exact) < 2 * len(small) else small


def _density(drawn: object) -> int:
    return 1 if isinstance(drawn, np.ndarray) else SHARP


def encode_change(image: web.Image, first: web.Image | None = None) -> bytes:
    """Return `image` as WebP that is painted over `first`: without loss, or in small what is a photograph.

    Without loss it is what differs from the first picture, and transparent elsewhere.

    Examples
    --------
    >>> page = np.full((200, 300), 255, np.uint8)
    >>> len(encode_change(page, page)) < 100
    True
    """
    over = web.as_rgb(image)
    lossless = _is_drawing(image)
    if first is not None and first.shape == image.shape:
        changed = (over != web.as_rgb(first)).any(axis=-1)
        over = np.dstack([over, np.uint8(255) * changed])
        lossless = lossless or changed.mean() < FEW_CHANGED
    return web.encode_webp(over, lossless=True) if lossless else web.encode_webp(image, quality=75)


def _is_drawing(image: web.Image) -> bool:
    """Tell a plot, whose rows are a few runs of one colour each, from a photograph or a map like one."""
    return len(web.encode_runs(image)) <= web.MAX_RUN_BYTES * image.shape[0] * image.shape[1]


def is_ink(image: web.Image) -> bool:
    """Tell a plot, lines on white paper: a dark page turns its ink into chalk.

    The colours of a picture, or of a map, mean something.
    """
    white = (image == 255).all(axis=-1)
    edges = np.concatenate([white[[0, -1]].ravel(), white[:, [0, -1]].ravel()])
    return bool(white.mean() > PAPER and edges.mean() > MARGIN)


def render(drawn: object, density: int = 1) -> NDArray[np.uint8]:
    """Return what a draw function returned as a picture (H, W) or (H, W, 3) uint8, or raise a ValueError.

    A plot has `density` times as many pixels along a side.
    """
    figure = getattr(drawn, "figure", None)
    if hasattr(figure, "savefig"):
        return _pixels(figure, density)
    pixels = isinstance(drawn, np.ndarray) and drawn.dtype == np.uint8 and drawn.size > 0
    if isinstance(drawn, np.ndarray) and pixels and (drawn.ndim == 2 or drawn.shape[2:] == (3,)):
        return drawn
    came = (
        f"an array of {describe(drawn)}" if isinstance(drawn, np.ndarray) else type(drawn).__name__
    )
    raise InputError(
        f"expected draw to return a uint8 picture (H, W[, 3]), an Axes or a Figure, got {came}"
    )


def pictured(drawn: object) -> list[list[float]]:
    """Return left, top, width and height, as shares of what was rendered, of its Axes that hold pictures.

    Where none does, those of its first Axes; none for a picture. A dark page leaves them their
    colours.
    """
    axes = getattr(getattr(drawn, "figure", None), "axes", [])
    boxes = [ax.get_position() for ax in [ax for ax in axes if ax.images] or axes[:1]]
    return [[box.x0, 1 - box.y1, box.width, box.height] for box in boxes]


def require_alt(alt: str) -> str:
    """Return the alt text, or raise a ValueError where it says nothing."""
    if not isinstance(alt, str) or not alt.strip():
        raise InputError(f"expected an alt text that says what the picture shows, got {alt!r}")
    return alt


def short(value: object) -> str:
    """Return a value as a reader wants it beside a slider: numbers to four digits."""
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
    said = short(value)
    if isinstance(value, str | bool):
        return said if isinstance(value, str) else f"{'with' if value else 'without'} {words}"
    if letter := SIGNS.get(name, name if len(name) <= 2 else ""):
        return f"{letter} = {said}"
    if not name.endswith("s") or name.endswith(("ss", "us")):
        return f"{words} {said}"
    return f"{said} {words[:-1] if said == '1' else words}"


def _pixels(figure: Any, density: int) -> NDArray[np.uint8]:
    dpi = figure.dpi
    figure.set_dpi(density * dpi)
    # which knows the widths of words from the picture before
    known = type(figure.canvas) is FigureCanvasAgg
    canvas = figure.canvas if known else FigureCanvasAgg(figure)
    reuse.paint(canvas)
    figure.set_dpi(dpi)
    # else a figure of pyplot's is shown once more, below the cell
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close(figure)
    return np.array(canvas.buffer_rgba())[..., :3]


def _scales(low: int, high: int) -> tuple[figures.Scale, figures.Scale]:
    """Return the ticks in stops, and those in decades."""
    few = (high - low) * DECADE <= 3
    decades = figures.scale(low * DECADE, high * DECADE, digits=int(few))
    return figures.scale(low, high, digits=int(high - low < 4)), decades
