"""Plots of leaderboards: bars from best to worst, and ranks that change with the metric."""

import numpy as np
import pytest

from hdrlab.show import pictures
from hdrlab.show.plots.lectures import leaderboards

NAMES = ["a", "b", "c"]
TABLES = {
    "first": {"a": 3.0, "b": 2.0, "c": 1.0},
    "second": {"c": np.inf, "a": 2.0, "b": 1.0},
}


def texts(ax):
    return [text.get_text() for text in ax.texts]


def test_bars_stand_in_the_order_of_the_scores_with_names_and_numbers():
    ax = leaderboards.draw_scores({"b": 31.46, "a": 0.5}, label="PSNR, dB", names=["a", "b"])
    assert texts(ax) == ["b", "31.5", "a", "0.500"]
    tops = [bar.get_y() for bar in ax.patches]
    assert tops == sorted(tops) and ax.yaxis_inverted()
    assert [bar.get_width() for bar in ax.patches] == [31.46, 0.5]
    assert ax.get_xlabel() == "PSNR, dB"


def test_a_perfect_score_has_the_longest_bar_and_the_sign_of_infinity():
    ax = leaderboards.draw_scores(TABLES["second"], label="dB", names=NAMES, limit=40)
    assert ax.patches[0].get_width() == 40 and "∞" in texts(ax)


def test_a_name_keeps_its_color_in_every_leaderboard():
    def colors(scores):
        ax = leaderboards.draw_scores(scores, label="dB", names=NAMES)
        named = [text for text in texts(ax) if text in NAMES]
        return {name: bar.get_facecolor() for name, bar in zip(named, ax.patches, strict=True)}

    assert colors(TABLES["first"]) == colors(TABLES["second"])
    assert len(set(colors(TABLES["first"]).values())) == 3


def test_ranks_are_lines_from_one_order_to_the_other_with_the_names_at_both_ends():
    ax = leaderboards.draw_ranks(TABLES, names=NAMES)
    assert [line.get_ydata().tolist() for line in ax.lines] == [[1, 2], [2, 3], [3, 1]]
    assert sorted(texts(ax)) == sorted(NAMES * 2)
    assert [label.get_text() for label in ax.get_xticklabels()] == ["first", "second"]


def test_names_of_a_dozen_letters_stay_inside_the_plot():
    names = ["local_laplacian", "low contrast"]
    tables = dict.fromkeys("abcdef", dict.fromkeys(names, 1.0))
    ax = leaderboards.draw_ranks(tables, names=names)
    pictures.render(ax)
    frame = ax.get_window_extent()
    for text in ax.texts:
        box = text.get_window_extent()
        assert frame.x0 <= box.x0 and box.x1 <= frame.x1


@pytest.mark.parametrize(
    ("tables", "names", "message"),
    [
        ({"first": TABLES["first"]}, NAMES, "two or more tables"),
        (TABLES, ["a", "b"], "the same in each table"),
        (dict.fromkeys("xy", dict.fromkeys("abcdefghi", 1.0)), list("abcdefghi"), "1 to 8 names"),
    ],
)
def test_tables_that_are_no_leaderboards_raise_an_error(tables, names, message):
    with pytest.raises(ValueError, match=message):
        leaderboards.draw_ranks(tables, names=names)
