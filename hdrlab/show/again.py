"""Axes that are drawn on again: most of a line plot's time goes into making its axes and their ticks.

`widgets.play` and `widgets.tune` draw many plots one after the other. Inside `drawn`, `plots.axes` hands out
the Axes of the picture before, wiped, where `keep` found nothing on them that wiping would leave behind.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, TypeVar

from matplotlib import rcParams
from matplotlib.axes import Axes

State = TypeVar("State")
Size = tuple[float, float]  # of the figure, inches


class Kept:
    """Axes between two pictures: `spare` ones, by size, and those that were handed out since."""

    def __init__(self) -> None:
        self.spare: dict[Size, Axes] = {}
        self.out: dict[Size, tuple[Axes, object]] = {}


_kept: ContextVar[Kept | None] = ContextVar("kept", default=None)


@contextmanager
def reusing(kept: Kept) -> Iterator[None]:
    """Let `plots.axes` take Axes from `kept` while this lasts."""
    token = _kept.set(kept)
    kept.out.clear()
    try:
        yield
    finally:
        _kept.reset(token)


def drawn(
    draw: Callable[[State], object], state: State, finish: Callable[[object], bytes], kept: Kept
) -> bytes:
    """Return finish(draw(state)), drawn on spare Axes where there are some."""
    with reusing(kept):
        picture = draw(state)
    frame = finish(picture)
    keep(kept, picture)
    return frame


def take(size: Size) -> Axes | None:
    """Return spare Axes of this size, wiped, or None; nobody gets the same ones in one picture."""
    kept = _kept.get()
    ax = kept.spare.pop(size, None) if kept else None
    return ax and handed_out(size, wiped(ax))


def handed_out(size: Size, ax: Axes) -> Axes:
    """Return these Axes of `plots.axes`, and remember how they look."""
    if kept := _kept.get():
        kept.out[size] = (ax, look(ax))
    return ax


def keep(kept: Kept, drawn: object) -> None:
    """Keep the Axes of a picture for the next one, if it has no others and wiping makes them as new."""
    for size, (ax, as_new) in kept.out.items():
        if getattr(drawn, "figure", None) is ax.figure and alone(ax) and look(ax) == as_new:
            kept.spare[size] = ax


def alone(ax: Axes) -> bool:
    """Return whether the figure has nothing but these Axes."""
    figure: Any = ax.figure
    return figure.axes == [ax] and not (ax.child_axes or figure.texts or figure.legends or figure.images)


def look(ax: Axes) -> object:
    """Return what a drawing may change and `wiped` does not bring back."""
    axis = [
        (
            [each.get_tick_params(which) for which in ("major", "minor")],
            each.get_visible(),
            each.label.get_color(),
            each.label.get_fontsize(),
        )
        for each in (ax.xaxis, ax.yaxis)
    ]
    frame = [(spine.get_visible(), spine.get_edgecolor()) for spine in ax.spines.values()]
    ground = (ax.figure.get_facecolor(), ax.get_axisbelow(), ax.axison)
    return (axis, frame, ground, ax.title.get_color(), ax.get_position().bounds, ax.margins())


def wiped(ax: Axes) -> Axes:
    """Return the Axes without what was drawn on them: linear, with limits that follow what comes."""
    for group in (ax.lines, ax.collections, ax.patches, ax.texts, ax.images, ax.artists, ax.tables):
        for artist in list(group):
            artist.remove()
    if legend := ax.get_legend():
        legend.remove()
    for side in ("left", "center", "right"):
        ax.set_title("", loc=side, fontsize=rcParams["axes.titlesize"])
    ax.set(xscale="linear", yscale="linear", aspect="auto", facecolor=rcParams["axes.facecolor"])
    ax.set(xlabel="", ylabel="", xlim=(0, 1), ylim=(0, 1))
    ax.set_prop_cycle(None)
    ax.relim()
    ax.autoscale(True)
    return ax
