"""Drawings of alignment by bitmaps."""

from dataclasses import replace

import numpy as np
import pytest

from hdrlab.align import mtb
from hdrlab.pipeline.alignment import register
from hdrlab.show import pictures
from hdrlab.show.plots.lectures import bitmaps as drawn

RNG = np.random.default_rng(0)
COARSE = RNG.integers(0, 256, (14, 18)).astype(np.uint8)
WALL = np.kron(COARSE, np.ones((8, 8), np.uint8))  # (112, 144)
# which lies on the first moved by (-3, 4)
PAIR = np.stack([WALL[8:104, 8:136], WALL[5:101, 12:140]])
STATES = list(mtb.align_steps(PAIR))


def titles(drawn):
    return [ax.get_title() for ax in drawn.figure.axes]


def test_equal_bits_are_black_or_white_and_different_bits_orange():
    picture = drawn.overlay([[0, 1, 0, 1]], [[0, 1, 1, 0]])
    assert picture[0, :2].tolist() == [[26] * 3, [255] * 3]
    assert picture[0, 2:].tolist() == [list(drawn.DIFFERENT_BIT_COLOR)] * 2


def test_excluded_bits_are_blue():
    picture = drawn.overlay([[0, 1, 0]], [[0, 0, 1]], [[False, False, True]])
    assert picture[0].tolist() == [list(drawn.EXCLUDED_BIT_COLOR)] * 2 + [
        list(drawn.DIFFERENT_BIT_COLOR)
    ]


def test_colors_of_an_overlay_differ_in_gray():
    gray = [
        np.dot(colour, (0.3, 0.59, 0.11))
        for colour in (*drawn.EQUAL_BIT_COLORS, drawn.DIFFERENT_BIT_COLOR, drawn.EXCLUDED_BIT_COLOR)
    ]
    assert np.diff(np.sort(gray)).min() > 40


@pytest.mark.parametrize(
    ("b", "compared"), [(np.zeros((2, 3)), None), (np.zeros((2, 2)), np.ones((2, 3)))]
)
def test_overlay_rejects_bitmaps_of_different_sizes(b, compared):
    with pytest.raises(ValueError, match="bitmaps"):
        drawn.overlay(np.zeros((2, 2)), b, compared)


def test_no_bits_differ_at_the_true_offset():
    state = STATES[-1]
    ax = drawn.difference(state.fixed, state.moving, state.offset)
    assert titles(ax) == [
        f"moved by ({state.offset[0]}, {state.offset[1]}): 0.00 % of the bits differ"
    ]
    shown = ax.images[0].get_array()
    assert not np.all(shown == drawn.DIFFERENT_BIT_COLOR, axis=-1).any()
    beside = drawn.difference(state.fixed, state.moving, (0, 0)).images[0].get_array()
    assert np.all(beside == drawn.DIFFERENT_BIT_COLOR, axis=-1).mean() > 0.1


def test_error_in_the_title_is_the_fraction_of_orange_among_compared_bits():
    state = STATES[-1]
    ax = drawn.difference(state.fixed, state.moving, (1, 1))
    shown = ax.images[0].get_array()
    orange = np.all(shown == drawn.DIFFERENT_BIT_COLOR, axis=-1).sum()
    compared = (~np.all(shown == drawn.EXCLUDED_BIT_COLOR, axis=-1)).sum()
    assert f"{100 * orange / compared:.2f} %" in titles(ax)[0]


@pytest.mark.parametrize("state", STATES, ids=lambda state: f"level{state.level}")
def test_best_of_nine_offsets_has_an_orange_frame(state):
    figure = drawn.nine(state)
    assert len(figure.axes) == 9
    framed = [
        ax.get_title()
        for ax in figure.axes
        if ax.spines["top"].get_linewidth() == 3 and ax.spines["top"].get_edgecolor()[0] > 0.8
    ]
    best = 100 * min(state.errors.values())
    assert framed == [f"({state.offset[0]}, {state.offset[1]}): {best:.2f} %"]


def test_center_is_framed_in_a_tie():
    flat = np.zeros((2, 40, 64), bool)
    flat[1] = True  # all compared, and equal
    state = mtb.State(0, flat, flat, mtb.step(flat, flat, (0, 0)), (0, 0))
    widths = [ax.spines["top"].get_linewidth() for ax in drawn.nine(state).axes]
    assert np.flatnonzero(np.array(widths) == 3).tolist() == [4]


def test_plots_of_validations_show_the_failure_and_have_the_same_height():
    state = STATES[-1]
    pair = replace(register(PAIR, "mtb").pairs[0], failure="")
    good = drawn.validated(state, pair)
    bad = drawn.validated(state, replace(pair, failure="it " * 30))
    assert "it it" not in titles(good)[0] and titles(bad)[0].count("it it") > 1
    assert pictures.render(good).shape == pictures.render(bad).shape


def test_surface_has_dy_down_and_dx_across_and_marks_at_their_offsets():
    errors = np.ones((7, 7))
    errors[3 + 2, 3 - 1] = 0
    figure = drawn.surface(errors, marks={"true": (2, -1), "found": (0, 0)})
    ax = figure.axes[0]
    left, right, bottom, top = ax.images[0].get_extent()
    assert (left, right, bottom, top) == (-3.5, 3.5, 3.5, -3.5)
    assert [(line.get_xdata()[0], line.get_ydata()[0]) for line in ax.lines] == [(-1, 2), (0, 0)]
    assert ax.images[0].get_array()[5, 2] == 0


@pytest.mark.parametrize("errors", [np.ones((4, 4)), np.ones((3, 5)), np.ones(5)])
def test_surface_rejects_errors_without_a_middle(errors):
    with pytest.raises(ValueError, match="errors"):
        drawn.surface(errors)


def test_words_draws_rows_of_bits_with_their_names():
    figure = drawn.words({"A": [1, 0, 1], "B": [0, 0, 1]})
    ax = figure.axes[0]
    assert [text.get_text() for text in ax.texts] == list("101001")
    assert [label.get_text() for label in ax.get_yticklabels()] == ["A", "B"]


def test_words_rejects_rows_of_different_lengths():
    with pytest.raises(ValueError, match="one length"):
        drawn.words({"A": [1, 0, 1], "B": [0, 0]})
