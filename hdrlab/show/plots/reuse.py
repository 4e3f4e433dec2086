"""Reuse of Axes and blitting: most of a line plot's time goes into making its axes and their ticks.

`widgets.play` and `widgets.tune` draw many plots one after the other. Inside `draw_reusing`,
`plots.axes` and the like return the Axes of the picture before, wiped, where `keep` found nothing
on them that wiping would
leave behind. `paint` keeps the pixels of their background, which is the patch with ticks, numbers and grid:
where these are the same as in the picture before, they are blitted, and only the artists upon them
are drawn.
"""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from itertools import chain
from typing import Any, TypeVar

from matplotlib import rcParams
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg

State = TypeVar("State")
Picture = TypeVar("Picture")
# of the figure, inches, and where in it its Axes lie if not in the usual place
Size = tuple[float, ...]


class Kept:
    """Axes between two pictures, by size: `spare` ones, those handed `out` since, and pixels."""

    def __init__(self) -> None:
        self.spare: dict[Size, list[Axes]] = {}
        self.out: dict[Size, tuple[list[Axes], list[object]]] = {}
        self.background: dict[Size, tuple[object, Any]] = {}


_kept: ContextVar[Kept | None] = ContextVar("kept", default=None)


def draw_reusing(
    draw: Callable[[State], object], state: State, finish: Callable[[object], Picture], kept: Kept
) -> Picture:
    """Return finish(draw(state)), drawn on spare Axes where there are some."""
    token = _kept.set(kept)
    kept.out.clear()
    try:
        shown = draw(state)
        picture = finish(shown)
    finally:
        _kept.reset(token)
    keep(kept, shown)
    return picture


def take(size: Size, make: Callable[[], list[Axes]]) -> list[Axes]:
    """Return the spare Axes of a figure of this size, wiped, or new ones; a picture gets those once."""
    if (kept := _kept.get()) is None:
        return make()
    axes = [wipe(ax) for ax in kept.spare.pop(size, [])] or make()
    kept.out[size] = (axes, [look(ax) for ax in axes])
    return axes


def keep(kept: Kept, drawn: object) -> None:
    """Keep the Axes of a picture for the next one, if it has no others and wiping makes them as new."""
    for size, (axes, as_new) in kept.out.items():
        mine = getattr(drawn, "figure", None) is axes[0].figure
        if mine and unchanged(axes, as_new):
            kept.spare[size] = axes


def unchanged(axes: list[Axes], as_new: list[object]) -> bool:
    """Return whether the figure has nothing but these Axes, and they look as new once they are wiped."""
    figure: Any = axes[0].figure
    more = (figure.texts, figure.legends, figure.images, *(ax.child_axes for ax in axes))
    return figure.axes == axes and not any(more) and [look(ax) for ax in axes] == as_new


def look(ax: Axes) -> object:
    """Return what a drawing may change and `wipe` does not bring back."""
    both = (ax.xaxis, ax.yaxis)
    ticked = [each.get_tick_params(which) for each in both for which in ("major", "minor")]
    axis = [
        (each.get_visible(), each.label.get_color(), each.label.get_fontsize()) for each in both
    ]
    frame = [(spine.get_visible(), spine.get_edgecolor()) for spine in ax.spines.values()]
    background = (ax.figure.get_facecolor(), ax.get_axisbelow(), ax.axison)
    return (
        ticked,
        axis,
        frame,
        background,
        ax.title.get_color(),
        ax.get_position().bounds,
        ax.margins(),
    )


def wipe(ax: Axes) -> Axes:
    """Return the Axes without what was drawn on them: linear, with limits that follow what comes."""
    groups = (ax.lines, ax.collections, ax.patches, ax.texts, ax.images, ax.artists, ax.tables)
    for artist in list(chain(*groups)):
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


def paint(canvas: FigureCanvasAgg) -> None:
    """Draw the canvas's figure; where its background is as before, only what stands upon it."""
    kept = _kept.get()
    figure = canvas.figure
    mine = (
        [(size, *out) for size, out in kept.out.items() if out[0][0].figure is figure]
        if kept
        else []
    )
    if kept is None or not mine or not separable(*mine[0][1:]):
        canvas.draw()
        return
    size, axes, as_new = mine[0]
    background = [figure.patch, *(part for ax in axes for part in (ax.patch, ax.xaxis, ax.yaxis))]
    marks = as_new, [(ax.get_facecolor(), ticks(ax.xaxis), ticks(ax.yaxis)) for ax in axes]
    before, pixels = kept.background.get(size, (None, None))
    if before == marks:
        canvas.restore_region(pixels)
    else:
        with hidden(child for ax in axes for child in ax.get_children() if child not in background):
            canvas.draw()
        kept.background[size] = (marks, canvas.copy_from_bbox(figure.bbox))
    with hidden(background):
        figure.draw(canvas.get_renderer())


def separable(axes: list[Axes], as_new: list[object]) -> bool:
    """Return whether the background of Axes lies below all else, and is nothing but ticks and labels."""
    plain = unchanged(axes, as_new) and all(ax.get_aspect() == "auto" for ax in axes)
    return plain and all(map(_background_below, axes))


def _background_below(ax: Axes) -> bool:
    background = max(ax.xaxis.get_zorder(), ax.yaxis.get_zorder())
    above = (child for child in ax.get_children() if child not in (ax.patch, ax.xaxis, ax.yaxis))
    return not ax.axison or all(child.get_zorder() > background for child in above)


def ticks(axis: Axis) -> object:
    """Return all that makes an axis look as it does, beside `look`: its ends, its ticks and their numbers."""
    numbers = (axis.get_major_formatter(), axis.get_minor_formatter())
    places = (axis.get_majorticklocs().tolist(), axis.get_minorticklocs().tolist())
    said = [
        (at, to.format_ticks(at), to.get_offset()) for to, at in zip(numbers, places, strict=True)
    ]
    return tuple(axis.get_view_interval()), axis.get_scale(), axis.get_label_text(), said


@contextmanager
def hidden(artists: Iterable[Artist]) -> Iterator[None]:
    """Leave these out of what is drawn while this lasts."""
    shown = [artist for artist in artists if artist.get_visible()]
    try:
        for artist in shown:
            artist.set_visible(False)
        yield
    finally:
        for artist in shown:
            artist.set_visible(True)
