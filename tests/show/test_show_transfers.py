"""Plots that compare two photos: comparagram, ranks, staircase, ladders, equations."""

import numpy as np
import pytest
from matplotlib.legend import Legend

from hdrlab.core import transfer
from hdrlab.response.grossberg import comparagram
from hdrlab.show import pictures
from hdrlab.show.plots.lectures import transfers

LEVELS = np.arange(256)


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def two(k=2):
    """Return histograms (256,) of uniform light, and of k times as much."""
    light = (np.arange(40_000) + 0.5) / 40_000 * 120
    return [np.bincount(np.floor(light * s + 0.5).astype(int), minlength=256) for s in (1, k)]


def test_comparagram_has_the_first_frame_on_x_and_the_second_on_y():
    A = np.full((4, 4), 30, np.uint8)
    B = np.full((4, 4), 200, np.uint8)
    ax = transfers.comparagram(comparagram(A, B))
    shown = ax.images[0].get_array()
    assert shown[200, 30] == 16 and np.ma.count(np.ma.masked_invalid(shown)) == 1
    assert "frame A" in ax.get_xlabel() and "frame B" in ax.get_ylabel()


def test_color_scale_of_a_comparagram_ignores_clipped_pixels():
    J = np.zeros((256, 256))
    J[255, 255] = 1e6
    J[100, 120] = 400
    J[50, 60] = 2
    ax = transfers.comparagram(J)
    norm = ax.images[0].norm
    assert norm.vmax == 400 and norm.vmin == 2
    assert legend(ax) == ["10", "100"] and ax.get_legend().get_title().get_text() == "pixels"


def test_legend_of_a_comparagram_does_not_cover_the_ridge():
    brighter = np.roll(np.eye(256), 20, axis=1)
    places = [transfers.comparagram(J).get_legend()._loc for J in (brighter, brighter.T)]
    assert places == [Legend.codes["lower right"], Legend.codes["upper left"]]


def test_transfer_is_drawn_on_its_comparagram():
    ax = transfers.comparagram(np.eye(256), T=LEVELS / 2)
    assert all(np.array_equal(line.get_ydata(), LEVELS / 2) for line in ax.lines)
    assert legend(ax) == ["1", "T, from the histograms"]


@pytest.mark.parametrize("J", [np.zeros((256, 256)), np.ones((4, 5)), np.ones(256)])
def test_comparagram_rejects_arrays_that_are_not_square_or_empty(J):
    with pytest.raises(ValueError, match=r"comparagram \(n, n\) with counts in it"):
        transfers.comparagram(J)


def test_ranks_connects_pixel_values_of_equal_rank():
    h = two()
    ax = transfers.ranks(*h, 40, transfer.brightness_transfer(*h))
    way = ax.lines[2]
    assert np.allclose(way.get_xdata(), [40, 40, 80, 80], atol=0.01)
    height = way.get_ydata()[1]
    assert height == way.get_ydata()[2] and abs(height - 100 / 3) < 0.3
    assert "40" in legend(ax)[2] and "80" in legend(ax)[2]


def test_ranks_shows_that_a_pixel_value_is_clipped_in_the_other_frame():
    h = two(4)
    clipped = np.concatenate([h[1][:200], [h[1][200:].sum()], np.zeros(55, int)])
    T = np.where(LEVELS < 50, transfer.brightness_transfer(h[0], clipped), np.nan)
    ax = transfers.ranks(h[0], clipped, 90, T)
    assert "clipped" in legend(ax)[2] and set(ax.lines[2].get_xdata()) == {90}


def test_staircase_alternates_between_the_diagonal_and_the_transfer():
    s = np.array([240.0, 120, 60])
    ax = transfers.staircase(LEVELS / 2, s)
    x, y = ax.lines[2].get_data()
    assert list(zip(x, y, strict=True)) == [(240, 240), (240, 120), (120, 120), (120, 60), (60, 60)]
    assert legend(ax)[2].startswith("3 ")


def test_ladder_of_a_power_law_is_a_line_whose_slope_is_the_exponent():
    s = 240 * 0.5 ** (0.45 * np.arange(8))
    ax = transfers.ladders({"gamma": (s, 0.5)})
    points, line = ax.lines
    assert legend(ax) == ["gamma: slope 0.45"]
    assert np.allclose(points.get_ydata(), line.get_ydata())
    assert points.get_xdata().tolist() == list(range(0, -8, -1))


def test_equations_subtracts_a_multiple_and_marks_rejected_equations():
    x = np.arange(1.0, 11)
    used = np.arange(10) != 4
    ax = transfers.equations(x, 4 * x + np.where(used, 0, 9), used, 4.02, against=4)
    out, kept, line = ax.lines
    assert out.get_ydata().tolist() == [9] and np.allclose(kept.get_ydata(), 0)
    assert np.allclose(line.get_ydata(), [0, 0.2])
    assert [label.split()[0] for label in legend(ax)] == ["1", "9", "k"]
    assert "4 ×" in ax.get_ylabel()


def test_every_plot_of_a_transfer_can_be_rendered():
    h = two()
    T = transfer.brightness_transfer(*h)
    for ax in (
        transfers.comparagram(np.eye(256)),
        transfers.ranks(*h, 40, T),
        transfers.staircase(LEVELS / 2, np.array([240.0, 120])),
        transfers.ladders({"linear": (np.array([240.0, 120, 60]), 0.5)}),
        transfers.equations(LEVELS, 2 * LEVELS, LEVELS > 5, 2.0),
    ):
        assert pictures.render(ax).ndim == 3
