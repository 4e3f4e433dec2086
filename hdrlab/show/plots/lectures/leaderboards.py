"""Draw leaderboards: scores from best to worst, and how the ranks change with the metric.

scores   name -> score, best first, as `radiance.scores.sort_scores` returns them
tables   label of a metric -> scores; every table has the same names

Each name keeps its color, so that a reader can follow it from one leaderboard to the next.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from hdrlab.errors import InputError
from hdrlab.show.plots import BLACK, COLORS, LINE_DASHES, axes

# Color and marker of each contestant.
NAME_COLORS = (*COLORS, BLACK, "#7F7F7F")
NAME_MARKERS = "osD^vP*X"
# Fraction of the largest score that is left free for the numbers beside the bars.
NUMBER_ROOM = 0.22
# Fraction of the axis that the names take on each side of the ranks.
NAME_ROOM = 0.2


def draw_scores(
    scores: Mapping[str, float],
    *,
    label: str,
    names: Sequence[str],
    limit: float | None = None,
) -> Axes:
    """Draw a bar for each score from top to bottom, with its name in it and its number beside it.

    `names` lists all contestants in a fixed order, which gives them their colors. `limit` fixes the
    end of the axis, so that a button moves only the bars.
    """
    _require_names(scores, names)
    finite = [score for score in scores.values() if np.isfinite(score)]
    end = limit or max(finite, default=1.0)
    ax = axes(6.4, 3.6)
    for row, (name, score) in enumerate(scores.items()):
        length = min(score, end)
        color = NAME_COLORS[list(names).index(name)]
        ax.barh(row, length, height=0.72, color=color, alpha=0.4)
        ax.text(0.012 * end, row, name, va="center", color=BLACK, fontsize=10)
        ax.text(length + 0.012 * end, row, _format_score(score), va="center", fontsize=10)
    ax.set(
        xlim=(0, (1 + NUMBER_ROOM) * end),
        ylim=(len(scores) - 0.5, -0.5),
        xlabel=label,
        ylabel="rank",
    )
    ax.set_yticks(range(len(scores)), [str(rank) for rank in range(1, len(scores) + 1)])
    ax.grid(visible=False, axis="y")
    return ax


def draw_ranks(tables: Mapping[str, Mapping[str, float]], *, names: Sequence[str]) -> Axes:
    """Draw a line for each name through its ranks in several tables; where lines cross, the order turns.

    `names` lists all contestants in a fixed order, which gives them their colors.
    """
    if len(tables) < 2:
        raise InputError(f"expected two or more tables of scores, got {len(tables)}")
    for scores in tables.values():
        _require_names(scores, names)
    ranks = np.array(
        [[list(scores).index(name) + 1 for name in names] for scores in tables.values()]
    )
    columns = np.arange(len(tables))
    side = NAME_ROOM * columns[-1] / (1 - 2 * NAME_ROOM)
    ax = axes(7.0, 0.9 + 0.34 * len(names) + 0.4)
    for k, name in enumerate(names):
        color = NAME_COLORS[k]
        ax.plot(
            columns,
            ranks[:, k],
            color=color,
            linestyle=LINE_DASHES[k % len(LINE_DASHES)],
            marker=NAME_MARKERS[k],
            markersize=6,
            linewidth=2,
        )
        ax.text(-0.12, ranks[0, k], name, ha="right", va="center")
        ax.text(columns[-1] + 0.12, ranks[-1, k], name, ha="left", va="center")
    ax.set(
        xlim=(-side, columns[-1] + side),
        ylim=(len(names) + 0.5, 0.5),
        ylabel="rank",
    )
    ax.set_xticks(columns, list(tables), fontsize=8)
    ax.set_yticks(range(1, len(names) + 1))
    ax.grid(visible=False, axis="x")
    return ax


def _require_names(scores: Mapping[str, float], names: Sequence[str]) -> None:
    """Raise an InputError if scores are not those of these names, or there are too many."""
    if set(scores) != set(names) or not 0 < len(names) <= len(NAME_COLORS):
        raise InputError(
            f"expected scores of 1 to {len(NAME_COLORS)} names, the same in each table, "
            f"got {', '.join(scores)} and {', '.join(names)}"
        )


def _format_score(score: float) -> str:
    """Return a score as text: three decimals up to 1, as of SSIM and TMQI, and one for decibels."""
    if np.isinf(score):
        return "∞"
    return f"{score:.3f}" if abs(score) <= 1 else f"{score:.1f}"
