"""Widgets for notebooks: play steps, tune parameters, compare pictures, ask questions, brush.

play     draws every state once; the browser moves through the frames, without a kernel
tune     calls a function for each move of a slider; pages without a kernel show stored pictures
wipe     two pictures with a movable edge between them: `show.widgets.compared`
blink    pictures that blink at one place: `show.widgets.compared`
predict  a question to answer before the result is shown: `show.widgets.predict`
brush    the Detail Brush over a radiance map: `show.widgets.lens`
exposure_window  drag the range of a photo along a histogram: `show.widgets.exposure`
bitmap_difference  drag one bitmap over another, count the bits that differ: `show.widgets.bitmaps`
zone_scale  drag Reinhard's key and white point along the zones: `show.widgets.zones`
gain_screen  drag a screen's headroom, see base and gain map on it: `show.widgets.gains`
bilateral_kernel  drag the kernel of the bilateral filter along a line: `show.widgets.kernel`
gradient_line  drag Fattal's attenuation of the gradients of a line: `show.widgets.gradients`
gsolve_by_hand  drag pixels sideways until they lie on one curve: `show.widgets.gsolve`
pixel_mean  press a pixel: what each photo claims, and the weighted mean: `show.widgets.pixel`
screen_match  two sliders measure the gamma and the black of the screen: `show.widgets.screen`

`play` and `tune` work with every algorithm: `states` is any iterable (the library's
`<verb>_steps`, or your own generator), `f` is any function, and `draw` returns a uint8 image (H, W)
or (H, W, 3), an Axes or a Figure.
"""

import gc
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from itertools import islice
from typing import Any, TypeVar

import anywidget  # noqa: F401  first, so that the error names it if it is missing
import traitlets
from threadpoolctl import ThreadpoolController

from hdrlab.errors import InputError
from hdrlab.io import web
from hdrlab.show.pictures import (
    Picture,
    encode,
    encode_change,
    picture_areas,
    render,
    require_alt,
)
from hdrlab.show.plots import reuse
from hdrlab.show.widgets import positions
from hdrlab.show.widgets.bitmaps import BitmapDifference, bitmap_difference
from hdrlab.show.widgets.compared import Blinker, Wiper, blink, wipe
from hdrlab.show.widgets.exposure import ExposureWindow, exposure_window
from hdrlab.show.widgets.gains import GainScreen, gain_screen
from hdrlab.show.widgets.gradients import GradientLine, gradient_line
from hdrlab.show.widgets.gsolve import GsolveByHand, gsolve_by_hand
from hdrlab.show.widgets.kernel import BilateralKernel, bilateral_kernel
from hdrlab.show.widgets.lens import Brush, brush
from hdrlab.show.widgets.pixel import PixelMean, pixel_mean
from hdrlab.show.widgets.screen import ScreenMatch, screen_match
from hdrlab.show.widgets.scripts import Widget, script
from hdrlab.show.widgets.zones import ZoneScale, zone_scale

__all__ = [
    "BilateralKernel",
    "BitmapDifference",
    "Blinker",
    "Brush",
    "ExposureWindow",
    "GainScreen",
    "GradientLine",
    "GsolveByHand",
    "PixelMean",
    "Player",
    "ScreenMatch",
    "Tuner",
    "Wiper",
    "ZoneScale",
    "bilateral_kernel",
    "bitmap_difference",
    "blink",
    "brush",
    "exposure_window",
    "gain_screen",
    "gradient_line",
    "gsolve_by_hand",
    "pixel_mean",
    "play",
    "screen_match",
    "tune",
    "wipe",
    "zone_scale",
]

State = TypeVar("State")

# The threads of the linear algebra libraries that are loaded by now.
BLAS_THREADS = ThreadpoolController()
# Stored pictures of `tune` by default: readers wait for most of them about a second.
DEFAULT_STORED_PICTURES = 48
MAX_STORED_BYTES = 500_000
# Frames of `play`: a page with more opens slowly, and a generator may never end.
MAX_FRAMES = 200


@contextmanager
def undisturbed() -> Iterator[None]:
    """Pause the garbage collector, which would otherwise interrupt the drawing of a plot."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


class Player(Widget):
    """Frames to move through; `index` is the one that is shown."""

    _esm = script("play.js")
    frames = traitlets.List(traitlets.Bytes()).tag(sync=True)  # WebP
    alts = traitlets.List(traitlets.Unicode()).tag(sync=True)
    name = traitlets.Unicode("step").tag(sync=True)
    index = traitlets.Int(0).tag(sync=True)
    areas = traitlets.List(traitlets.List(traitlets.Float())).tag(sync=True)  # see picture_areas

    def still(self) -> Picture:
        """Return the first frame."""
        return Picture(tuple(self.frames[:1]), tuple(self.alts[:1]), ("",), areas=(self.areas,))


def play(
    states: Iterable[State],
    draw: Callable[[State], object],
    *,
    alt: str | Callable[[State], str],
    name: str = "step",
) -> Player:
    """Return a widget that plays draw(state) for each state.

    Parameters
    ----------
    states : iterable
        The states of an algorithm, 1 to 200 of them.
    draw : function
        Takes a state, and returns a uint8 image, an Axes or a Figure. The Axes of `plots` are
        reused for the next frame, so `draw` must not keep them.
    alt : str, or function of a state
        What the picture shows. hdrlab adds the step's number to a str.
    name : str
        What the slider counts.

    Raises
    ------
    InputError
        For no states or too many, an empty alt text, or a `draw` that returns something else.

    Examples
    --------
    >>> import numpy as np
    >>> def square(k):
    ...     return np.full((4, 4), 80 * k, np.uint8)
    >>> player = play(range(3), square, alt="A square that gets lighter")
    >>> player.alts[1]
    'A square that gets lighter, step 2'
    """
    frames = []
    alts = []
    kept = reuse.Kept()
    areas = list[list[float]]()

    def finish(drawn: object) -> tuple[bytes, list[list[float]]]:
        return encode(drawn), picture_areas(drawn)

    for number, state in enumerate(islice(states, MAX_FRAMES + 1), 1):
        frame, areas = reuse.draw_reusing(draw, state, finish, kept)
        frames.append(frame)
        if callable(alt):
            alts.append(require_alt(alt(state)))
        else:
            alts.append(f"{require_alt(alt)}, {name} {number}")
    if not 0 < len(frames) <= MAX_FRAMES:
        got = "more" if frames else "none"
        raise InputError(f"expected 1 to {MAX_FRAMES} states to play, got {got}")
    return Player(frames=frames, alts=alts, name=name, areas=areas)


class Tuner(Widget):
    """Sliders for a function's parameters: `at` are their positions, `frame` the picture of `shown`."""

    _esm = script("tune.js")
    names = traitlets.List(traitlets.Unicode()).tag(sync=True)
    # what readers see beside each slider: words, and the text of each position
    labels = traitlets.List(traitlets.Unicode()).tag(sync=True)
    values = traitlets.List(traitlets.List(traitlets.Unicode())).tag(sync=True)
    # The browser moves the sliders, so it needs no echo.
    at = traitlets.List(traitlets.Int()).tag(sync=True, echo_update=False)
    shown = traitlets.List(traitlets.Int()).tag(sync=True)
    frame = traitlets.Bytes().tag(sync=True)  # as `web.encode_frame` makes it
    alt = traitlets.Unicode().tag(sync=True)
    problem = traitlets.Unicode().tag(sync=True)  # what the function raised, in words
    answers = traitlets.Int(0).tag(sync=True)  # counts the pictures, so that each answer is noticed
    stored_at = traitlets.List(traitlets.List(traitlets.Int())).tag(sync=True)
    # WebP; each is painted over the first
    stored = traitlets.List(traitlets.Bytes()).tag(sync=True)
    point = traitlets.List(traitlets.Unicode()).tag(sync=True)  # the two sliders that a press moves
    # the parameters that get a row of buttons, because their values have no order
    unordered = traitlets.List(traitlets.Unicode()).tag(sync=True)
    areas = traitlets.List(traitlets.List(traitlets.Float())).tag(sync=True)  # see picture_areas

    def __init__(
        self,
        picture: Callable[[list[int]], web.Image],
        grids: positions.Grids,
        captions: Mapping[str, str],
        **traits: Any,
    ):
        self._picture = picture
        self._grids = grids
        labels = []
        texts = []
        for name, grid in grids.items():
            label, grid_texts = positions.caption_texts(name, grid, captions.get(name))
            labels.append(label)
            texts.append(grid_texts)
        unordered = [name for name, grid in grids.items() if positions.is_unordered(grid)]
        super().__init__(
            names=list(grids), labels=labels, values=texts, unordered=unordered, **traits
        )
        self.observe(self._answer, "at")

    @property
    def parameters(self) -> dict[str, Any]:
        """The current values of the sliders, by name."""
        return positions.values(self._grids, self.at)

    def still(self) -> Picture:
        """Return the picture of the sliders' first positions."""
        return Picture(tuple(self.stored[:1]), (self.alt,), ("",), areas=(self.areas,))

    def _answer(self, _: object) -> None:
        """Show the picture of the current positions; in a burst of moves, only the last one counts."""
        at = list(self.at)
        frame = self.frame
        problem = ""
        with undisturbed():
            try:
                frame = web.encode_frame(self._picture(at))
            except Exception as error:  # it may be a student's function: show its error
                problem = f"{type(error).__name__}: {error}"
            with self.hold_sync():
                self.frame = frame
                self.shown = at
                self.problem = problem
                self.answers += 1


def tune(
    f: Callable[..., Any],
    draw: Callable[[Any], object],
    /,
    *,
    alt: str,
    stored: int = DEFAULT_STORED_PICTURES,
    point: tuple[str, str] | None = None,
    captions: Mapping[str, str] | None = None,
    **ranges: Any,
) -> Tuner:
    """Return a widget with a slider for each parameter, which shows draw(f(...)).

    A list of names, such as operators, gets a row of buttons instead.

    Parameters
    ----------
    f : function
        Its parameters named in `ranges` get sliders, which start at its defaults, or else in the
        middle.
    draw : function
        Takes what `f` returns, and returns an image as for `play`.
    alt : str
        What the picture shows; the widget adds the values of the parameters.
    stored : int
        The largest number of pictures that are computed in advance, for pages without a kernel: all
        positions, or an even grid of them, of at most 0.5 MB. Pass a smaller number if `f` is slow.
        The environment variable HDRLAB_STORED overrides it, for example for the site. Positions at
        which `f` raises an error are left out.
    point : (down, right), optional
        Two of the parameters, fractions of the picture from 0 to 1, that a click on the picture
        sets as well.
    captions : dict, optional
        The words and the unit beside each slider as a format string, such as
        {"read_noise": "read noise {:g} electrons"}. A parameter without one is shown by its name.
    **ranges : (low, high), (low, high, step), or a list of values
        A tuple is a range, of integers if both ends are integers, and in 100 steps otherwise. A
        list contains the values themselves.

    Raises
    ------
    InputError
        For bad ranges, parameters that `f` does not have, a point that is not two of them, a
        caption of another parameter or without a place for the value, an empty alt text, or a
        `draw` that returns something else.

    Examples
    --------
    >>> import numpy as np
    >>> def square(level=100):
    ...     return np.full((4, 4), level, np.uint8)
    >>> tuner = tune(square, lambda picture: picture, alt="A gray square", level=(0, 255))
    >>> tuner.parameters
    {'level': 100}
    """
    require_alt(alt)
    grids = {name: positions.grid(name, choices) for name, choices in ranges.items()}
    if not grids:
        raise InputError("expected at least one range, such as smoothness=(1, 100), got none")
    if point is not None and (len(point) != 2 or not set(point) <= set(grids)):
        raise InputError(
            f"expected a point of two parameters out of {', '.join(grids)}, got {point!r}"
        )
    unknown = sorted(set(captions or ()) - set(grids))
    if unknown:
        raise InputError(
            f"expected captions of {', '.join(grids)}, got one of {', '.join(unknown)}"
        )

    kept = reuse.Kept()

    def picture(at: list[int], finish: Callable[[object], Any] = render) -> Any:
        # The systems are small, so that threads would only wait for each other.
        with BLAS_THREADS.limit(limits=1):
            return reuse.draw_reusing(draw, f(**positions.values(grids, at)), finish, kept)

    def finish_first(drawn: object) -> tuple[web.Image, list[list[float]]]:
        return render(drawn), picture_areas(drawn)

    start = positions.start(f, grids)
    first, areas = picture(start, finish_first)
    stored_at = [start]
    frames = [encode_change(first)]
    max_pictures = int(os.environ.get("HDRLAB_STORED", stored))
    max_pictures = min(max_pictures, MAX_STORED_BYTES // len(frames[0]))
    for position in positions.beforehand(grids, start, max_pictures)[1:]:
        with suppress(Exception):  # the widget shows the error when a reader moves there
            frames.append(encode_change(picture(position), first))
            stored_at.append(position)
    return Tuner(
        picture,
        grids,
        captions or {},
        at=start,
        shown=start,
        alt=alt,
        stored_at=stored_at,
        stored=frames,
        point=list(point or ()),
        areas=areas,
        frame=web.encode_frame(first),
    )
