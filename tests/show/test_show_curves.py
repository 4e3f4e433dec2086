"""Plots of labeled curves."""

import numpy as np
import pytest
from matplotlib.collections import LineCollection

from hdrlab.show import pictures
from hdrlab.show.plots import curves

LINEAR = np.log(np.arange(1, 257) / 129)
PLACES = np.arange(10.0)
NAMES = dict(across="turn", up="error, %")


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_lines_draws_each_curve_with_its_own_label_color_and_style():
    curves_by_name = {name: PLACES * k for k, name in enumerate("abcdef")}
    ax = curves.lines(PLACES, curves_by_name, **NAMES)
    assert legend(ax) == list("abcdef")
    assert ax.get_xlabel() == "turn"
    assert ax.get_ylabel() == "error, %"
    assert all(
        np.array_equal(line.get_ydata(), curves_by_name[line.get_label()]) for line in ax.lines
    )
    looks = {(line.get_color(), str(line._dash_pattern)) for line in ax.lines}
    assert len(looks) == len({line.get_color() for line in ax.lines}) == 6


def test_second_call_on_the_same_axes_continues_with_the_next_color():
    ax = curves.lines(PLACES, {"a": PLACES}, **NAMES)
    assert curves.lines(PLACES, {"b": PLACES}, ax=ax, **NAMES) is ax
    assert len({line.get_color() for line in ax.lines}) == 2 and legend(ax) == ["a", "b"]


def test_limits_fix_the_y_axis():
    ax = curves.lines(PLACES, {"a": 100 * PLACES}, limits=(0, 5), **NAMES)
    assert ax.get_ylim() == (0, 5)


def test_ticks_of_a_logarithmic_axis_are_plain_numbers():
    ax = curves.lines(PLACES, {"a": 10.0**-PLACES}, scale="log", **NAMES)
    pictures.render(ax)
    shown = [tick.get_text() for tick in ax.get_yticklabels()]
    assert "0.01" in shown and not any("$" in text for text in shown)


def test_lines_rejects_more_than_six_curves_and_curves_of_another_length():
    with pytest.raises(ValueError, match="6 curves.*7"):
        curves.lines(PLACES, {str(k): PLACES for k in range(7)}, **NAMES)
    with pytest.raises(ValueError, match=r"\(10,\)"):
        curves.lines(PLACES, {"a": PLACES[1:]}, **NAMES)


def test_deviation_of_a_response_that_is_one_stop_off_is_one():
    ax = curves.deviations({"right": LINEAR, "twice": LINEAR + np.log(2)}, LINEAR, limit=2)
    _, right, twice = ax.lines  # the first is the line of zero
    assert np.allclose(right.get_ydata(), 0) and np.allclose(twice.get_ydata(), 1)
    assert np.allclose(twice.get_xdata(), LINEAR[10:251] / np.log(2)) and ax.get_ylim() == (-2, 2)
    assert "stops" in ax.get_xlabel()
    assert "stops" in ax.get_ylabel()
    assert legend(ax) == ["right", "twice"]


def test_bundle_draws_all_curves_and_uses_no_color_of_the_named_ones():
    ax = curves.bundle(PLACES, [PLACES, 2 * PLACES, 3 * PLACES], label="three", **NAMES)
    curves.lines(PLACES, {"mean": 2 * PLACES}, ax=ax, **NAMES)
    drawn = [artist for artist in ax.collections if isinstance(artist, LineCollection)]
    assert len(drawn) == 1
    segments = drawn[0].get_segments()
    assert len(segments) == 3 and np.allclose(segments[2][:, 1], 3 * PLACES)
    assert legend(ax) == ["three", "mean"] and ax.lines[0].get_color() == curves.LINE_STYLES[0][0]
    assert ax.get_ylim()[1] >= 27


def test_quotients_of_the_true_curve_equal_the_ratios():
    R = np.array([0.5, 0.25])
    X = np.geomspace(0.1, 1, 30)[:, None] * [0.125, 0.25, 1]
    ax = curves.quotients(np.sqrt(X), X, R)
    for dots, ratio in zip(ax.lines[::2], R, strict=True):
        assert np.allclose(dots.get_ydata(), ratio) and len(dots.get_xdata()) == 30
    assert legend(ax) == ["R₁ = 0.500", "R₂ = 0.250"]


def test_samples_that_are_clipped_in_a_frame_have_no_quotient():
    M = np.array([[0.1, 0.2], [0.4, np.nan], [0.0, 0.0]])
    ax = curves.quotients(M, M, [0.5])
    assert ax.lines[0].get_xdata().tolist() == [0.2]


def test_quotients_rejects_arrays_of_different_shapes():
    with pytest.raises(ValueError, match=r"M and f\(M\) \(N, P\) and R \(P - 1,\)"):
        curves.quotients(np.ones((4, 3)), np.ones((4, 3)), [0.5])
