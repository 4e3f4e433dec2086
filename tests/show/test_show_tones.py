"""Plots of tone mapping: maps with a scale, trimmed histograms, and bands."""

import numpy as np
import pytest

from hdrlab.core.colour import encode_srgb
from hdrlab.show import pictures
from hdrlab.show.plots import tones
from hdrlab.tonemap import curves

RAMP = np.linspace(-1, 3, 24 * 36).reshape(24, 36)


def colours_of(figure, k=0):
    image = figure.axes[k].images[0]
    return image.cmap(image.norm(np.asarray(image.get_array())))


@pytest.mark.parametrize("count", [1, 2, 3])
def test_maps_have_their_names_and_one_labeled_scale(count):
    names = ["base", "detail", "k"][:count]
    figure = tones.maps(dict.fromkeys(names, RAMP), label="decades")
    assert [ax.get_title() for ax in figure.axes[:-1]] == names
    assert figure.axes[-1].get_xlabel() == "decades"
    height, width = pictures.render(figure).shape[:2]
    assert 500 < width < 1100 and height < width


def test_pixels_of_a_map_are_square():
    figure = tones.maps({"": RAMP}, label="decades")
    figure.canvas.draw()
    box = figure.axes[0].get_window_extent()
    assert box.width / box.height == pytest.approx(36 / 24, rel=0.01)


def test_signed_map_is_white_at_zero_violet_below_and_orange_above():
    v = np.array([[-2.0, 0.0, 1.0, 2.0]])
    low, zero, _, high = colours_of(tones.maps({"": v}, label="stops", signed=True))[0, :, :3]
    assert zero.min() > 0.93 and np.abs(low - high).max() > 0.3
    assert low[2] > low[0] and high[0] > high[2]  # violet below, orange above


def test_several_maps_have_the_same_scale():
    figure = tones.maps({"little": RAMP, "much": RAMP * 2}, label="decades")
    little = figure.axes[0].images[0].norm
    much = figure.axes[1].images[0].norm
    assert (little.vmin, little.vmax) == (much.vmin, much.vmax)


def test_span_fixes_the_ends_of_the_scale():
    norms = [
        tones.maps({"": RAMP * k}, label="x", span=(0, 2)).axes[0].images[0].norm for k in (1, 5)
    ]
    assert all((norm.vmin, norm.vmax) == (0, 2) for norm in norms)


def test_each_class_has_its_own_name_and_color():
    index = np.arange(8).reshape(2, 4)
    figure = tones.maps({"": index}, label="width, pixels", names=[1, 2, 3, 4, 5, 6, 7, 43])
    labels = [text.get_text() for text in figure.axes[-1].get_xticklabels()]
    assert labels == ["1", "2", "3", "4", "5", "6", "7", "43"]
    assert len(np.unique(colours_of(figure).reshape(-1, 4), axis=0)) == 8


def test_constant_map_can_be_drawn_and_nan_is_gray():
    assert pictures.render(tones.maps({"": np.ones((8, 12))}, label="x")).std() > 0
    v = RAMP.copy()
    v[0, 0] = np.nan
    assert np.allclose(colours_of(tones.maps({"": v}, label="x"))[0, 0, :3], 128 / 255, atol=0.01)


@pytest.mark.parametrize(
    "maps", [{}, {"a": np.zeros(4)}, {"a": RAMP, "b": RAMP[1:]}, dict.fromkeys("abcd", RAMP)]
)
def test_maps_rejects_none_too_many_and_maps_of_different_shapes(maps):
    with pytest.raises(ValueError, match="maps"):
        tones.maps(maps, label="x")


def test_trims_shows_the_histogram_before_and_after_and_the_ceiling():
    f = np.array([3.0, 9.0, 5.0])
    ax = tones.trims([0, 1, 2, 3], f, np.minimum(f, 4), ceiling=4)
    before, after = ax.patches
    assert before.get_data().values.tolist() == [3, 9, 5]
    assert after.get_data().values.tolist() == [3, 4, 4]
    assert ax.lines[0].get_ydata()[0] == 4
    assert "ceiling" in ax.get_legend().get_texts()[-1].get_text()


def test_trims_draws_no_ceiling_before_the_first_trim():
    ax = tones.trims([0, 1, 2], [3, 4], [3, 4])
    assert not ax.lines and ax.get_ylim()[1] > 4


def test_trims_rejects_edges_that_do_not_fit_the_bins():
    with pytest.raises(ValueError, match="one edge more"):
        tones.trims([0, 1, 2], [3, 4, 5], [3, 4, 5])


def test_bands_draws_a_global_curve_narrow_and_a_local_operator_wide():
    L = np.geomspace(1, 1024, 64 * 64).astype(np.float32).reshape(64, 64)
    global_curve = curves.tonemap(L)
    many = np.clip(global_curve * np.linspace(0.5, 1, 64, dtype=np.float32), 0, 1)
    ax = tones.bands({"curve": curves.spread(L, global_curve), "operator": curves.spread(L, many)})
    pairs = zip(ax.lines[::2], ax.lines[1::2], strict=True)
    widths = [np.median(high.get_ydata() - low.get_ydata()) for low, high in pairs]
    assert 0 < widths[0] < 5 < 20 < widths[1]
    # 10 stops in all, the median at 0
    assert ax.lines[0].get_xdata()[-1] == pytest.approx(5, abs=0.2)


def test_bands_are_in_srgb_encoded_display_values():
    ax = tones.bands({"gray": ([1.0, 2.0], [0.18, 0.5], [0.18, 0.5])}, middle=1)
    assert np.allclose(ax.lines[0].get_ydata(), 255 * encode_srgb(np.array([0.18, 0.5])))
    assert ax.lines[0].get_xdata().tolist() == [0, 1]


def test_bands_rejects_an_empty_mapping():
    with pytest.raises(ValueError, match="1 to 5 operators"):
        tones.bands({})
