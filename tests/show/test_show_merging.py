"""Plots of a pixel's radiance as estimated from each photo."""

import numpy as np
import pytest

from hdrlab.core import weights
from hdrlab.show import pictures
from hdrlab.show.plots.lectures import merging

G = np.log(np.maximum(np.arange(256), 0.5) / 128)  # a linear camera
B = np.log([0.25, 1.0, 4.0])
Z = np.array([0, 64, 255])
W = weights.hat()


def drawn(Z=Z, **knobs):
    return merging.draw_measurements(Z, B, G, W, np.log(0.5), **knobs)


def lines(ax):
    return {line.get_label(): line for line in ax.lines}


def test_measurement_is_g_minus_ln_t_in_stops():
    dots = [artist for artist in drawn().collections if artist.get_label() == "measured"]
    assert len(dots) == 1
    assert dots[0].get_offsets().tolist() == [[1.0, pytest.approx(-1.0)]]


def test_dark_and_clipped_pixels_are_arrows_down_and_up_from_their_bounds():
    ax = drawn()
    down = lines(ax)["at most"]
    up = lines(ax)["at least"]
    at_most = np.log2(1 / 128 / 0.25)
    at_least = np.log2(250 / 128 / 4)
    assert (down.get_xdata()[0], up.get_xdata()[0]) == (0, 2)
    assert down.get_ydata()[0] < at_most and up.get_ydata()[0] > at_least
    starts = [c.get_segments()[0][0] for c in ax.collections if hasattr(c, "get_segments")][1:]
    assert [start.tolist() for start in starts] == [
        [2, pytest.approx(at_least)],
        [0, pytest.approx(at_most)],
    ]


def test_bar_of_a_measurement_spans_the_light_that_rounds_to_its_pixel_value():
    bar = next(c for c in drawn().collections if hasattr(c, "get_segments")).get_segments()[0]
    assert np.allclose(2 ** bar[:, 1] * 128, [63.5, 64.5], atol=0.01)


def test_dots_are_larger_for_larger_weights():
    dots = next(
        c for c in drawn(np.array([10, 64, 127])).collections if c.get_label() == "measured"
    )
    assert np.all(np.diff(dots.get_sizes()) > 0)


def test_merged_and_true_value_are_lines_in_stops_from_the_middle():
    ax = drawn(middle=np.log(2), truth=np.log(8))
    assert lines(ax)["merged"].get_ydata()[0] == pytest.approx(-2)
    assert lines(ax)["truth"].get_ydata()[0] == pytest.approx(2)


def test_ticks_show_exposure_times_and_pixel_values():
    labels = [text.get_text() for text in drawn().get_xticklabels()]
    assert labels == ["1/4 s\n0", "1 s\n64", "4 s\n255"]


@pytest.mark.parametrize("levels", [[0, 0, 0], [255, 255, 255], [100, 120, 140]])
def test_only_dark_clipped_or_measured_pixels_can_be_drawn(levels):
    assert pictures.render(drawn(np.array(levels))).std() > 0


def test_draw_measurements_rejects_pixel_values_without_times():
    with pytest.raises(ValueError, match=r"Z and B \(P,\)"):
        merging.draw_measurements(Z[:2], B, G, W, 0.0)
