"""Reuse Axes and blit backgrounds, because most of a line plot's time goes into axes and ticks.

`widgets.play` and `widgets.tune` draw many plots one after the other. Inside `draw_reusing`,
`plots.axes` and the like return the Axes of the previous plot, cleared by `wipe`. `keep` decides
whether Axes can be reused: only if `wipe` restores everything that the plot changed. `paint` keeps
the pixels of the background (patch, ticks, numbers and grid). If the next plot has the same
background, `paint` copies its pixels and draws only the other artists.
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
# Width and height of a figure in inches, and the places of its Axes unless they are the usual ones.
Size = tuple[float, ...]


class Kept:
    """Axes and backgrounds that are kept between two plots, by size.

    Attributes
    ----------
    spare : Axes that can be reused
    out : Axes that the current plot uses, and their look before it
    background : the marks of the last background (see `paint`), and its pixels
    """

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
        drawn = draw(state)
        picture = finish(drawn)
    finally:
        _kept.reset(token)
    keep(kept, drawn)
    return picture


def take(size: Size, make: Callable[[], list[Axes]]) -> list[Axes]:
    """Return cleared spare Axes of this size, or new ones; one plot gets the spare Axes only once."""
    kept = _kept.get()
    if kept is None:
        return make()
    spare = kept.spare.pop(size, [])
    axes = [wipe(ax) for ax in spare] if spare else make()
    kept.out[size] = (axes, [look(ax) for ax in axes])
    return axes


def keep(kept: Kept, drawn: object) -> None:
    """Keep the Axes of a plot for the next one, if `wipe` restores all that the plot changed."""
    for size, (axes, as_new) in kept.out.items():
        is_drawn_on = getattr(drawn, "figure", None) is axes[0].figure
        if is_drawn_on and unchanged(axes, as_new):
            kept.spare[size] = axes


def unchanged(axes: list[Axes], as_new: list[object]) -> bool:
    """Return whether the figure has only these Axes, and they would look as new after `wipe`."""
    figure: Any = axes[0].figure
    children = [figure.texts, figure.legends, figure.images]
    children += [ax.child_axes for ax in axes]
    if figure.axes != axes or any(children):
        return False
    return [look(ax) for ax in axes] == as_new


def look(ax: Axes) -> object:
    """Return all properties that a plot may change and `wipe` does not restore."""
    tick_params = []
    labels = []
    for axis in (ax.xaxis, ax.yaxis):
        tick_params += [axis.get_tick_params(which) for which in ("major", "minor")]
        labels.append((axis.get_visible(), axis.label.get_color(), axis.label.get_fontsize()))
    frame = [(spine.get_visible(), spine.get_edgecolor()) for spine in ax.spines.values()]
    background = (ax.figure.get_facecolor(), ax.get_axisbelow(), ax.axison)
    return (
        tick_params,
        labels,
        frame,
        background,
        ax.title.get_color(),
        ax.get_position().bounds,
        ax.margins(),
    )


def wipe(ax: Axes) -> Axes:
    """Remove all artists from the Axes, make them linear with automatic limits, and return them."""
    groups = (ax.lines, ax.collections, ax.patches, ax.texts, ax.images, ax.artists, ax.tables)
    for artist in list(chain(*groups)):
        artist.remove()
    legend = ax.get_legend()
    if legend:
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
    """Draw the canvas's figure; if its background is that of the previous plot, copy the pixels."""
    kept = _kept.get()
    figure = canvas.figure
    size = _size_of(kept, figure)
    if kept is None or size is None or not separable(*kept.out[size]):
        canvas.draw()
        return
    axes, as_new = kept.out[size]
    background: list[Artist] = [figure.patch]
    for ax in axes:
        background += [ax.patch, ax.xaxis, ax.yaxis]
    marks = (as_new, [(ax.get_facecolor(), ticks(ax.xaxis), ticks(ax.yaxis)) for ax in axes])
    previous_marks, pixels = kept.background.get(size, (None, None))
    if previous_marks == marks:
        canvas.restore_region(pixels)
    else:
        children = chain.from_iterable(ax.get_children() for ax in axes)
        with hidden(child for child in children if child not in background):
            canvas.draw()
        kept.background[size] = (marks, canvas.copy_from_bbox(figure.bbox))
    with hidden(background):
        figure.draw(canvas.get_renderer())


def _size_of(kept: Kept | None, figure: object) -> Size | None:
    """Return the size under which a figure's Axes were taken, or None if they were not."""
    if kept is None:
        return None
    for size, (axes, _) in kept.out.items():
        if axes[0].figure is figure:
            return size
    return None


def separable(axes: list[Axes], as_new: list[object]) -> bool:
    """Return whether the background can be drawn first, because all other artists are above it."""
    if not unchanged(axes, as_new):
        return False
    return all(ax.get_aspect() == "auto" and _is_background_below(ax) for ax in axes)


def _is_background_below(ax: Axes) -> bool:
    """Return whether all artists of the Axes are above the ticks and the grid."""
    if not ax.axison:
        return True
    background = max(ax.xaxis.get_zorder(), ax.yaxis.get_zorder())
    others = [child for child in ax.get_children() if child not in (ax.patch, ax.xaxis, ax.yaxis)]
    return all(child.get_zorder() > background for child in others)


def ticks(axis: Axis) -> object:
    """Return the properties of an axis that `look` leaves out: ends, scale, label, ticks, numbers."""
    major_ticks = axis.get_majorticklocs().tolist()
    minor_ticks = axis.get_minorticklocs().tolist()
    numbers = []
    for formatter, locations in (
        (axis.get_major_formatter(), major_ticks),
        (axis.get_minor_formatter(), minor_ticks),
    ):
        numbers.append((locations, formatter.format_ticks(locations), formatter.get_offset()))
    return tuple(axis.get_view_interval()), axis.get_scale(), axis.get_label_text(), numbers


@contextmanager
def hidden(artists: Iterable[Artist]) -> Iterator[None]:
    """Hide artists while the context lasts."""
    visible = [artist for artist in artists if artist.get_visible()]
    try:
        for artist in visible:
            artist.set_visible(False)
        yield
    finally:
        for artist in visible:
            artist.set_visible(True)
