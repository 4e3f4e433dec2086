"""Pictures on Axes: to the bit what matplotlib draws, wherever they lie and whatever they hold.

Where the centre of a screen's pixel lies on the edge between two of the picture's, either may be
taken: the sizes here avoid that.
"""

import io

import numpy as np
import pytest
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from hdrlab.show.pictures import render
from hdrlab.show.plots.nearest import show


def ours(ax, picture, **knobs):
    show(ax, picture, **knobs)


def theirs(ax, picture, *, colours=None, **knobs):
    ax.imshow(picture, cmap=colours, interpolation="nearest", aspect="auto", **knobs)


def drawn(way, picture, *, place=(0, 0, 1, 1), inches=(3, 2), limits=None, **knobs):
    ax = Figure(inches, dpi=100).add_axes(place)
    way(ax, picture, **knobs)
    if limits is not None:
        ax.set(xlim=limits[0], ylim=limits[1])
    return render(ax)


def same(picture, **knobs):
    return np.array_equal(drawn(ours, picture, **knobs), drawn(theirs, picture, **knobs))


@pytest.mark.papers
@pytest.mark.parametrize("shape", [(1, 1), (7, 401), (191, 287), (200, 300), (500, 900)])
def test_a_picture_is_drawn_to_the_bit_as_by_matplotlib_larger_and_smaller_and_as_it_is(shape):
    rng = np.random.default_rng(1)
    assert same(rng.integers(0, 256, (*shape, 3), dtype=np.uint8))
    assert same(rng.normal(size=shape), colours="viridis", norm=Normalize(-2, 2))


@pytest.mark.papers
@pytest.mark.parametrize("seed", range(12))
def test_a_picture_is_drawn_to_the_bit_as_by_matplotlib_wherever_the_axes_lie(seed):
    rng = np.random.default_rng(seed)
    place = (*rng.uniform(0, 0.3, 2), *rng.uniform(0.3, 0.7, 2))
    picture = rng.integers(0, 256, (*rng.integers(3, 300, 2), 3), dtype=np.uint8)
    assert same(picture, place=place, inches=tuple(rng.uniform(2, 6, 2)))


def test_what_is_not_a_number_has_the_colour_that_the_colours_give_it():
    v = np.arange(60.0).reshape(6, 10)
    v[2, 3:5] = np.nan
    assert same(v, colours="PuOr_r", norm=Normalize(0, 60))


def test_a_part_of_a_picture_is_shown_where_the_axes_end_within_it():
    picture = np.random.default_rng(2).integers(0, 256, (40, 60, 3), dtype=np.uint8)
    assert same(picture, limits=((5.2, 31), (33.3, 8)))
    assert same(picture, limits=((100, 200), (100, 200)))  # none of it
    assert not np.array_equal(
        drawn(ours, picture), drawn(ours, picture, limits=((5.2, 31), (33.3, 8)))
    )


def test_a_picture_fills_the_extent_that_it_is_given():
    ramp = np.linspace(0, 1, 100)[None]
    assert same(ramp, colours="viridis", norm=Normalize(0, 1), extent=(-3, 5, 0, 1))


def test_a_picture_is_in_a_drawing_of_lines_too():
    ax, file = Figure((3, 2)).add_axes((0, 0, 1, 1)), io.BytesIO()
    show(ax, np.eye(4), colours="gray")
    ax.figure.savefig(file, format="svg")
    assert b"data:image/png;base64" in file.getvalue()
