"""`nearest.show` draws the same pixels as `imshow`.

Where the center of a screen pixel is on the edge between two image pixels, either is right. The
sizes here avoid that.
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
def test_show_equals_imshow_bit_for_bit_for_images_of_all_sizes(shape):
    rng = np.random.default_rng(1)
    assert same(rng.integers(0, 256, (*shape, 3), dtype=np.uint8))
    assert same(rng.normal(size=shape), colours="viridis", norm=Normalize(-2, 2))


@pytest.mark.papers
@pytest.mark.parametrize("seed", range(12))
def test_show_equals_imshow_bit_for_bit_for_axes_at_any_place(seed):
    rng = np.random.default_rng(seed)
    place = (*rng.uniform(0, 0.3, 2), *rng.uniform(0.3, 0.7, 2))
    picture = rng.integers(0, 256, (*rng.integers(3, 300, 2), 3), dtype=np.uint8)
    assert same(picture, place=place, inches=tuple(rng.uniform(2, 6, 2)))


def test_nan_has_the_same_color_as_with_imshow():
    v = np.arange(60.0).reshape(6, 10)
    v[2, 3:5] = np.nan
    assert same(v, colours="PuOr_r", norm=Normalize(0, 60))


def test_limits_inside_the_image_show_the_same_part_as_imshow():
    picture = np.random.default_rng(2).integers(0, 256, (40, 60, 3), dtype=np.uint8)
    assert same(picture, limits=((5.2, 31), (33.3, 8)))
    assert same(picture, limits=((100, 200), (100, 200)))  # none of it
    assert not np.array_equal(
        drawn(ours, picture), drawn(ours, picture, limits=((5.2, 31), (33.3, 8)))
    )


def test_extent_has_the_same_meaning_as_with_imshow():
    ramp = np.linspace(0, 1, 100)[None]
    assert same(ramp, colours="viridis", norm=Normalize(0, 1), extent=(-3, 5, 0, 1))


def test_image_is_part_of_an_svg():
    ax = Figure((3, 2)).add_axes((0, 0, 1, 1))
    file = io.BytesIO()
    show(ax, np.eye(4), colours="gray")
    ax.figure.savefig(file, format="svg")
    assert b"data:image/png;base64" in file.getvalue()
