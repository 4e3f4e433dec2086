"""The published experiments that `python -m benchmarks papers` repeats.

If a complete experiment takes too long, the name of the test says how much of it runs. The limits are the
same.
"""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("benchmarks", reason="the benchmarks are no part of the installed package")

from benchmarks import experiments
from benchmarks.experiments import spread
from benchmarks.papers import ROWS, cerman, curves, mitsunaga, space, wilburn

pytestmark = pytest.mark.papers

NOWHERE = Path("nowhere")  # no data there: they are looked for in ../shared/data
EXPERIMENTS = {row.name: row for row in ROWS}
QUICK = [
    "cerman-figure3",
    "cerman-ratio",
    "emor",
    "mitsunaga-figure4",
    "mitsunaga-canon",
    "mitsunaga-flat",
]


@pytest.fixture(autouse=True)
def one_process(monkeypatch):
    monkeypatch.setattr(experiments, "PROCESSES", 1)


def met(name, figures):
    """Return the verdict of each hold of an experiment."""
    return {hold.what: hold.verdict(figures) for hold in EXPERIMENTS[name].holds}


@pytest.mark.parametrize("name", QUICK)
def test_an_experiment_holds_as_it_is_printed(name, shared):
    if name == "emor":
        shared("crf_curves")
    figures = experiments.findings(EXPERIMENTS[name], NOWHERE)
    assert set(met(name, figures).values()) == {"ok"}


def test_the_darkest_pairs_of_real_maps_hold_for_3_of_20_seeds(shared):
    shared("hdri_cc0")
    figures = cerman.real_pairs(NOWHERE, seeds=range(3))
    assert set(met("cerman-ratio-real", figures).values()) == {"ok"}


@pytest.fixture(scope="module")
def paper():
    """The paper's scheme alone, all 100 trials of eleven seeds."""
    seeds = (mitsunaga.SEED, *mitsunaga.OTHER_SEEDS)
    return {seed: mitsunaga.section5(seed=seed, ours=False) for seed in seeds}


def test_mitsunagas_scheme_is_as_good_as_published_on_100_cameras(paper):
    assert paper[mitsunaga.SEED].paper.max() <= 2.7 and paper[mitsunaga.SEED].turns.max() < 10


def test_on_100_cameras_of_each_of_ten_other_seeds_it_stays_below_3_2_percent(paper):
    assert max(errors.paper.max() for errors in paper.values()) <= 3.2
    assert max(errors.turns.max() for errors in paper.values()) < 10


@pytest.mark.parametrize("seed", [mitsunaga.SEED, mitsunaga.OTHER_SEEDS[0]])
def test_ours_beats_it_on_the_first_10_of_100_cameras_in_median_and_worst(seed):
    errors = mitsunaga.section5(seed=seed, trials=10)
    median, _, worst = spread(errors.ours)  # of ten, 95 % is all but the worst
    assert median <= 0.2 and worst <= 2.0
    assert median < np.median(errors.paper) / 2


def test_the_default_reads_all_201_measured_responses_within_its_limits(shared):
    shared("crf_curves")
    figures = curves.compared(NOWHERE, {curves.DEFAULT: curves.methods()[curves.DEFAULT]})
    assert met("curves", figures) == {curves.DEFAULT: "ok"}


def test_doubtful_times_spoil_the_default_more_than_what_is_offered_for_them_on_every_sixth_curve(
    shared,
):
    shared("crf_curves")
    used = {name: curves.methods(curves.BEST)[name] for name in (curves.DEFAULT, curves.BEST)}
    figures = curves.compared(NOWHERE, used, off=curves.OFF, which=range(0, 201, 6))
    assert met("curves-doubtful", figures) == {curves.BEST: "ok"}
    assert figures[curves.DEFAULT][0] > 1.2 * figures[curves.BEST][0]


def test_every_method_that_is_offered_has_a_row(shared):
    shared("crf_curves")
    figures = curves.compared(NOWHERE, curves.methods(curves.BEST, curves.ESTIMATED), which=(0,))
    assert {"debevec", "grossberg", "mann", "mitsunaga", "robertson", "space", curves.BEST} <= set(
        figures
    )


def test_a_method_that_refuses_a_bracket_has_a_row_with_its_error(shared):
    shared("crf_curves")
    answers = iter([True, False, True])

    def picky(bracket):
        if next(answers):
            raise ValueError("expected another picture")
        return curves.named("debevec", bracket)

    used = {"picky": picky, "debevec": curves.methods()["debevec"]}
    figures = curves.compared(NOWHERE, used, which=range(3))
    assert figures["picky, brackets refused"] == 2 and np.isfinite(figures["picky"]).all()
    assert "debevec, brackets refused" not in figures


def test_five_samples_and_the_prior_give_every_fourth_response_to_a_percent(shared):
    shared("crf_curves")
    assert 100 * space.five_samples(space.measured(NOWHERE)[::4]).mean() <= 1


def test_the_spline_reads_all_201_measured_responses_from_a_display(shared):
    shared("crf_curves")
    figures = wilburn.measured(NOWHERE, "display")
    assert set(met("wilburn-display", figures).values()) == {"ok"}


def test_the_spline_reads_three_of_201_measured_responses_from_motion_blur_in_median_and_worst(
    shared,
):
    shared("crf_curves")
    figures = wilburn.measured(NOWHERE, "blur", every=100)
    median, _, worst = figures[wilburn.RMSE]  # of three, 95 % is nearly the worst
    assert median <= 0.0005 and worst <= 0.006
    assert met("wilburn-blur", figures)[wilburn.DISPARITY] == "ok"


def test_left_and_right_edges_tell_10_motions_of_each_kind_apart():
    figures = wilburn.figure7(NOWHERE, trials=10)
    assert figures[wilburn.ACCEPTED] == figures[wilburn.REJECTED] == 10


def test_two_sets_of_table_1_are_better_than_published():
    figures = wilburn.sets("film", count=2)
    for way, (rmse, disparity, _) in wilburn.PUBLISHED.items():
        for curve in ("polynomial", "spline"):
            assert (
                figures[f"{way}, {curve}"][0] <= rmse and figures[f"{way}, {curve}"][1] <= disparity
            )
