"""lectures.bitmaps: what differs is orange, what is not compared blue, and the best of nine is framed."""

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
PAIR = np.stack(
    [WALL[8:104, 8:136], WALL[5:101, 12:140]]
)  # which lies on the first moved by (-3, 4)
STATES = list(mtb.align_steps(PAIR))


def titles(drawn):
    return [ax.get_title() for ax in drawn.figure.axes]


def test_bits_that_agree_are_dark_or_white_and_those_that_differ_orange():
    picture = drawn.overlay([[0, 1, 0, 1]], [[0, 1, 1, 0]])
    assert picture[0, :2].tolist() == [[26] * 3, [255] * 3]
    assert picture[0, 2:].tolist() == [list(drawn.DIFFER)] * 2


def test_what_is_not_compared_is_blue_whatever_its_bits():
    picture = drawn.overlay([[0, 1, 0]], [[0, 0, 1]], [[False, False, True]])
    assert picture[0].tolist() == [list(drawn.OUTSIDE)] * 2 + [list(drawn.DIFFER)]


def test_the_four_colours_part_in_gray_too():
    gray = [
        np.dot(colour, (0.3, 0.59, 0.11)) for colour in (*drawn.AGREE, drawn.DIFFER, drawn.OUTSIDE)
    ]
    assert np.diff(np.sort(gray)).min() > 40


@pytest.mark.parametrize(
    ("b", "compared"), [(np.zeros((2, 3)), None), (np.zeros((2, 2)), np.ones((2, 3)))]
)
def test_bitmaps_of_two_sizes_are_refused(b, compared):
    with pytest.raises(ValueError, match="bitmaps"):
        drawn.overlay(np.zeros((2, 2)), b, compared)


def test_at_the_true_offset_nothing_is_orange_and_the_title_says_so():
    state = STATES[-1]
    ax = drawn.difference(state.fixed, state.moving, state.offset)
    assert titles(ax) == [
        f"moved by ({state.offset[0]}, {state.offset[1]}): 0.00 % of the bits differ"
    ]
    shown = ax.images[0].get_array()
    assert not np.all(shown == drawn.DIFFER, axis=-1).any()
    beside = drawn.difference(state.fixed, state.moving, (0, 0)).images[0].get_array()
    assert np.all(beside == drawn.DIFFER, axis=-1).mean() > 0.1


def test_the_error_in_a_title_is_the_share_of_orange_among_what_is_compared():
    state = STATES[-1]
    ax = drawn.difference(state.fixed, state.moving, (1, 1))
    shown = ax.images[0].get_array()
    orange = np.all(shown == drawn.DIFFER, axis=-1).sum()
    compared = (~np.all(shown == drawn.OUTSIDE, axis=-1)).sum()
    assert f"{100 * orange / compared:.2f} %" in titles(ax)[0]


@pytest.mark.parametrize("state", STATES, ids=lambda state: f"level{state.level}")
def test_of_nine_differences_the_frame_of_the_best_is_orange(state):
    figure = drawn.nine(state)
    assert len(figure.axes) == 9
    framed = [
        ax.get_title()
        for ax in figure.axes
        if ax.spines["top"].get_linewidth() == 3 and ax.spines["top"].get_edgecolor()[0] > 0.8
    ]
    best = 100 * min(state.errors.values())
    assert framed == [f"({state.offset[0]}, {state.offset[1]}): {best:.2f} %"]


def test_in_a_tie_the_centre_is_framed():
    flat = np.zeros((2, 40, 64), bool)
    flat[1] = True  # all compared, and equal
    state = mtb.State(0, flat, flat, mtb.step(flat, flat, (0, 0)), (0, 0))
    widths = [ax.spines["top"].get_linewidth() for ax in drawn.nine(state).axes]
    assert np.flatnonzero(np.array(widths) == 3).tolist() == [4]


def test_a_validation_stands_above_its_picture_and_all_are_of_one_height():
    state = STATES[-1]
    found = replace(register(PAIR, "mtb").pairs[0], failure="")
    good, bad = (
        drawn.validated(state, found),
        drawn.validated(state, replace(found, failure="it " * 30)),
    )
    assert "no reason not to trust it" in titles(good)[0] and titles(bad)[0].count("it it") > 1
    assert pictures.render(good).shape == pictures.render(bad).shape


def test_the_surface_has_dy_down_and_dx_across_and_marks_lie_where_they_belong():
    errors = np.ones((7, 7))
    errors[3 + 2, 3 - 1] = 0
    figure = drawn.surface(errors, marks={"true": (2, -1), "found": (0, 0)})
    ax = figure.axes[0]
    left, right, bottom, top = ax.images[0].get_extent()
    assert (left, right, bottom, top) == (-3.5, 3.5, 3.5, -3.5)
    assert [(line.get_xdata()[0], line.get_ydata()[0]) for line in ax.lines] == [(-1, 2), (0, 0)]
    assert ax.images[0].get_array()[5, 2] == 0


@pytest.mark.parametrize("errors", [np.ones((4, 4)), np.ones((3, 5)), np.ones(5)])
def test_a_surface_without_a_middle_is_refused(errors):
    with pytest.raises(ValueError, match="errors"):
        drawn.surface(errors)


def test_rows_of_bits_are_written_out_under_their_names():
    figure = drawn.words({"A": [1, 0, 1], "B": [0, 0, 1]})
    ax = figure.axes[0]
    assert [text.get_text() for text in ax.texts] == list("101001")
    assert [label.get_text() for label in ax.get_yticklabels()] == ["A", "B"]


def test_rows_of_two_lengths_are_refused():
    with pytest.raises(ValueError, match="one length"):
        drawn.words({"A": [1, 0, 1], "B": [0, 0]})
