"""Widgets: steps to play, parameters to tune, pictures to compare, and the Detail Brush.

play   draws every state once and moves through the frames in the browser: at once, and with no kernel too
tune   calls a function on each move of a slider; its pictures are stored for a page that has no kernel
wipe   two pictures with a movable edge between them: `show.widgets.compared`
blink  pictures in one place, one after the other: `show.widgets.compared`
predict  a question that takes the answer before the picture comes: `show.widgets.predict`
brush  the Detail Brush over a radiance map: `show.widgets.lens`

The first two know no algorithm: `states` is any iterable (the library's `<verb>_steps`, or a
generator of yours), `f` any function, and `draw` returns a uint8 picture (H, W) or (H, W, 3), an
Axes or a Figure.
"""

import gc
import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from itertools import islice
from typing import Any, TypeVar

import anywidget  # noqa: F401  first, so that it is named where it is missing
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
    short,
)
from hdrlab.show.plots import reuse
from hdrlab.show.widgets import positions
from hdrlab.show.widgets.compared import Blinker, Wiper, blink, wipe
from hdrlab.show.widgets.lens import Brush, brush
from hdrlab.show.widgets.scripts import Widget, script

__all__ = ["Blinker", "Brush", "Player", "Tuner", "Wiper", "blink", "brush", "play", "tune", "wipe"]

State = TypeVar("State")

THREADS = ThreadpoolController()  # of the linear algebra that is loaded by now
STORED = 48  # pictures of a slider that are made while a reader waits, for most of them a second
HEAVIEST = 500_000  # bytes of them, on a page where nobody waits and more of them are made
MOST = 200  # frames: a page that carries more is slow to open, and a generator may never end


@contextmanager
def undisturbed() -> Iterator[None]:
    """Let Python look for garbage after an answer, and not in the midst of it: a plot leaves plenty."""
    was = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was:
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
        Takes a state, and returns a uint8 picture, an Axes or a Figure. The Axes of `plots` are
        drawn on again for the next picture, so it must not keep them.
    alt : str, or function of a state
        What the picture shows. To a str the step's number is added.
    name : str
        What the slider counts.

    Raises
    ------
    ValueError
        For no states or too many, an empty alt text, or a `draw` that returns something else.

    Examples
    --------
    >>> import numpy as np
    >>> player = play(range(3), lambda k: np.full((4, 4), 80 * k, np.uint8), alt="A square, ever lighter")
    >>> player.alts[1]
    'A square, ever lighter, step 2'
    """
    frames = []
    alts = []
    kept = reuse.Kept()
    areas = list[list[float]]()
    for k, state in enumerate(islice(states, MOST + 1)):
        frame, areas = reuse.draw_reusing(
            draw, state, lambda drawn: (encode(drawn), picture_areas(drawn)), kept
        )
        frames.append(frame)
        alts.append(
            require_alt(alt(state)) if callable(alt) else f"{require_alt(alt)}, {name} {k + 1}"
        )
    if not 0 < len(frames) <= MOST:
        raise InputError(
            f"expected 1 to {MOST} states to play, got {'none' if not frames else 'more'}"
        )
    return Player(frames=frames, alts=alts, name=name, areas=areas)


class Tuner(Widget):
    """Sliders on a function's parameters: `at` is where they stand, `frame` the picture of `shown`."""

    _esm = script("tune.js")
    names = traitlets.List(traitlets.Unicode()).tag(sync=True)
    # each position's text
    values = traitlets.List(traitlets.List(traitlets.Unicode())).tag(sync=True)
    # The browser moves this, and knows.
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
    areas = traitlets.List(traitlets.List(traitlets.Float())).tag(sync=True)  # see picture_areas

    def __init__(
        self, picture: Callable[[list[int]], web.Image], grids: positions.Grids, **traits: Any
    ):
        self._picture = picture
        self._grids = grids
        texts = [[short(value) for value in grid] for grid in grids.values()]
        super().__init__(names=list(grids), values=texts, **traits)
        self.observe(self._answer, "at")

    @property
    def parameters(self) -> dict[str, Any]:
        """The values at which the sliders stand, by name."""
        return positions.values(self._grids, self.at)

    def still(self) -> Picture:
        """Return the picture of where the sliders start."""
        return Picture(tuple(self.stored[:1]), (self.alt,), ("",), areas=(self.areas,))

    def _answer(self, _: object) -> None:
        """Show the picture of where the sliders stand now: of a burst of moves the last one wins."""
        at = list(self.at)
        frame = self.frame
        problem = ""
        with undisturbed():
            try:
                frame = web.encode_frame(self._picture(at))
            except (
                Exception
            ) as error:  # it may be a student's function: its words belong beside the slider
                problem = f"{type(error).__name__}: {error}"
            with self.hold_sync():
                self.frame, self.shown, self.problem, self.answers = (
                    frame,
                    at,
                    problem,
                    self.answers + 1,
                )


def tune(
    f: Callable[..., Any],
    draw: Callable[[Any], object],
    /,
    *,
    alt: str,
    stored: int = STORED,
    point: tuple[str, str] | None = None,
    **ranges: Any,
) -> Tuner:
    """Return a widget with a slider per parameter, which shows draw(f(...)) of where the sliders stand.

    Parameters
    ----------
    f : function
        Its parameters named in `ranges` get sliders, which start at its defaults, or else in the
        middle.
    draw : function
        Takes what `f` returns; else as for `play`.
    alt : str
        What the picture shows; the parameters' values are added.
    stored : int
        The most pictures that are computed now, for a page without a kernel: all positions, or else
        a grid of them, of at most 0.5 MB. Lower it where `f` takes long. The environment variable
        HDRLAB_STORED overrules it, as for the site, where nobody waits. A position at which `f`
        fails has none.
    point : (down, right), optional
        Two of the parameters, shares of the picture from 0 to 1, that a press on the picture sets,
        too.
    **ranges : (low, high), (low, high, step), or a list of values
        A tuple is a range: of integers where both ends are, else in 100 parts; a list holds the
        very values.

    Raises
    ------
    ValueError
        For bad ranges, parameters that `f` does not have, a point that is not two of them, an empty
        alt text, or a `draw` that returns something else.

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
    grids = {name: positions.grid(name, given) for name, given in ranges.items()}
    if not grids:
        raise InputError("expected at least one range, such as smoothness=(1, 100), got none")
    if point is not None and (len(point) != 2 or not set(point) <= set(grids)):
        raise InputError(
            f"expected a point of two parameters out of {', '.join(grids)}, got {point!r}"
        )

    kept = reuse.Kept()

    def picture(at: list[int], finish: Callable[[object], Any] = render) -> Any:
        with THREADS.limit(
            limits=1
        ):  # its systems are small: threads would only wait for each other
            return reuse.draw_reusing(draw, f(**positions.values(grids, at)), finish, kept)

    at = positions.start(f, grids)
    most = int(os.environ.get("HDRLAB_STORED", stored))
    first, areas = picture(at, lambda drawn: (render(drawn), picture_areas(drawn)))
    stored_at = [at]
    frames = [encode_change(first)]
    for position in positions.beforehand(grids, at, min(most, HEAVIEST // len(frames[0])))[1:]:
        with suppress(Exception):  # what a student's function refuses is told when it is asked for
            frames.append(encode_change(picture(position), first))
            stored_at.append(position)
    told = {"point": list(point or ()), "areas": areas, "frame": web.encode_frame(first)}
    return Tuner(
        picture, grids, at=at, shown=at, alt=alt, stored_at=stored_at, stored=frames, **told
    )
