"""The experiments of Mitsunaga and Nayar 1999: random cameras, two frames of unknown ratio, Canon, flatness.

error  mean of |f - truth| over the pixel levels, percent of the range

Section 5: `ambiguity.draw_trial` states how cameras, ratios, radiance and noise are drawn; a seed's
100 trials are drawn one after the other. The Canon's pictures are lost: its published ratios are
the truth of such a trial, with a camera of seed 0. Flat patches are 200 x 200 pixels of brightness
0.5 with noise of 0.01.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from benchmarks.experiments import Experiment, along, at_most, near, spread
from hdrlab.core.steps import last
from hdrlab.response import marginal, mitsunaga, polynomial, selection
from hdrlab.response.self_calibration import average
from hdrlab.show.plots.lectures import ambiguity

Float = NDArray[np.float64]
STATED = np.full(3, 0.5)
CANON = np.array([0.419, 0.292, 0.570, 0.512])
CANON_STATED = np.array([0.5, 0.25, 0.5, 0.5])
TRUST = 0.058  # standard deviation of ln R where R is uniform in 0.45 ... 0.55
SEED = 0
OTHER_SEEDS = tuple(range(1, 11))
PAPER = "the paper's scheme, worst mean error, %"
TURNS = "its turns, at most"
OURS = "ours: median, 95 %, worst, %"


class Trials(NamedTuple):
    """Section 5, trial by trial: errors and turns of the paper's scheme, errors of ours (if run)."""

    paper: Float
    turns: NDArray[np.intp]
    ours: Float


class Valley(NamedTuple):
    """Figure 4: the error (K,) at ratios R (K,), where it has local minima, and the ratio a search finds."""

    R: Float
    error: Float
    minima: Float
    found: float


def section5(*, seed: int = SEED, trials: int = 100, ours: bool = True) -> Trials:
    """Return the Trials of a seed [Mitsunaga99 fig. 3: at most 2.7 %, fewer than 10 turns].

    Ours takes about a second a trial.
    """
    rng = np.random.default_rng(seed)
    drawn = [ambiguity.draw_trial(rng) for _ in range(trials)]
    runs = [paper_states(trial) for trial in drawn]
    paper = [
        ambiguity.mean_error(states[-1].c[0], trial.c)
        for states, trial in zip(runs, drawn, strict=True)
    ]
    better = along(marginal_error, drawn, f"seed {seed}") if ours else []
    return Trials(np.array(paper), np.array([len(states) for states in runs]), np.array(better))


def paper_states(trial: ambiguity.Trial) -> list[mitsunaga.Fit]:
    """Return the paper's scheme, turn by turn, from ratios of 0.5."""
    return list(mitsunaga.fit_steps(average(trial.Z)[None], STATED, 5))


def marginal_error(trial: ambiguity.Trial) -> float:
    """Return the error of marginal maximum likelihood, from where the paper's scheme stopped."""
    start = paper_states(trial)[-1]
    return ambiguity.mean_error(
        marginal.fit(trial.Z, start.c[0], start.R, stated=STATED, trust=TRUST).c, trial.c
    )


def search_ratio(
    M: Float, start: float, order: int, *, reach: float = 1.25, steps: int = 81
) -> float:
    """Return the ratio of two frames M (N, 2) with the lowest error in start / reach ... start * reach.

    The line search of [Mitsunaga99 sec. 4]. For clean samples, which leave no error at the truth:
    noise lifts that minimum and moves it far, and then alternating is better.
    """
    R = start * reach ** np.linspace(-1, 1, steps)
    R = R[R < 1]
    k = int(np.argmin(ambiguity.scan_ratios(M, R, order)))
    fine = np.linspace(R[max(k - 1, 0)], R[min(k + 1, len(R) - 1)], steps)
    return float(fine[np.argmin(ambiguity.scan_ratios(M, fine, order))])


def scan_valley(
    c: Float, *, ratio: float = 0.7, start: float = 0.625, sigma: float = 0.0, rng: int = 0
) -> Valley:
    """Return figure 4 of the paper for a camera c: two frames, the truth at `ratio`, a guess at `start`.

    Samples are not quantised. With sigma = 0 the error touches 0 at the truth; with noise it does
    not.
    """
    draw = np.random.default_rng(rng)
    E = 10 ** draw.uniform(-2, 0, 1000)
    M = polynomial.brightness(E[:, None] * [ratio, 1], c) + sigma * draw.standard_normal((1000, 2))
    order = len(c) + 1
    R = np.linspace(0.3, 0.95, 261)
    error = ambiguity.scan_ratios(M, R, order)
    inner = (error[1:-1] < error[:-2]) & (error[1:-1] < error[2:])
    return Valley(R, error, R[1:-1][inner], search_ratio(M, start, order))


def figure4(*, seed: int = SEED, sigma: float = 0.0) -> Valley:
    """Return the error along the ratio of two frames, truth 0.7, and what a search from 0.625 finds."""
    return scan_valley(ambiguity.draw_curve(np.random.default_rng(seed)), sigma=sigma)


def canon(*, seed: int = SEED) -> tuple[Float, Float]:
    """Return the ratios (4,) of the Canon as the paper's scheme and ours find them, from the stated ones."""
    trial = ambiguity.draw_trial(np.random.default_rng(seed), ratios=CANON)
    paper = last(mitsunaga.fit_steps(average(trial.Z)[None], CANON_STATED, 5))
    return paper.R, marginal.fit(trial.Z, paper.c[0], paper.R).R


def kept(t: int, *, seed: int = SEED, side: int = 200, sigma: float = 0.01) -> float:
    """Return the percentage of flat patches that pass the test, of an average of t frames [sec. 6.1]."""
    noise = np.random.default_rng([seed, t]).normal(0.5, sigma, (t, side, side))
    return float(100 * selection.flat(noise, sigma=sigma)[2:-2, 2:-2].mean())


def cameras(_: Path) -> Mapping[str, ArrayLike]:
    """Return what 100 random cameras give."""
    errors = section5()
    return {PAPER: errors.paper.max(), TURNS: errors.turns.max(), OURS: spread(errors.ours)}


def other_seeds(_: Path) -> Mapping[str, ArrayLike]:
    """Return what ten times 100 others give: the worst seed's figures, and each seed's."""
    errors = {seed: section5(seed=seed) for seed in OTHER_SEEDS}
    spreads = {
        f"seed {seed}, {OURS}": spread(spread_of_seed.ours)
        for seed, spread_of_seed in errors.items()
    }
    return {
        f"worst seed, {PAPER}": max(
            spread_of_seed.paper.max() for spread_of_seed in errors.values()
        ),
        f"worst seed, {OURS}": np.max(list(spreads.values()), axis=0),
        "each seed, the paper's scheme, %": [
            spread_of_seed.paper.max() for spread_of_seed in errors.values()
        ],
        **spreads,
    }


def two_frames(_: Path) -> Mapping[str, ArrayLike]:
    """Return what figure 4 shows."""
    errors = figure4()
    return {"ratio found": errors.found, "local minima along the ratio": errors.minima}


def canon_ratios(_: Path) -> Mapping[str, ArrayLike]:
    """Return the Canon's ratios."""
    paper, ours = canon()
    return {"ratios, ours": ours, "ratios, the paper's scheme": paper}


def flatness(_: Path) -> Mapping[str, ArrayLike]:
    """Return the test's threshold, and what share of flat patches passes."""
    return {
        "threshold": selection.threshold(25, psi=0.05),
        "flat patches kept, %": [kept(1), kept(100)],
    }


ROWS = (
    Experiment(
        "mitsunaga",
        "100 random cameras of order 5, ratios of 0.45 to 0.55 stated as 0.5, noise 0.005, seed 0",
        cameras,
        (
            at_most(PAPER, 2.7, published="2.7"),
            at_most(TURNS, 9, published="< 10"),
            at_most(OURS, 0.2, 0.7, 2.0),
        ),
    ),
    Experiment(
        "mitsunaga-seeds",
        "the same with seeds 1 to 10",
        other_seeds,
        (at_most(f"worst seed, {PAPER}", 3.2), at_most(f"worst seed, {OURS}", 0.2, 0.7, 2.0)),
    ),
    Experiment(
        "mitsunaga-figure4",
        "two frames of ratio 0.7, a line search from 0.625",
        two_frames,
        (near("ratio found", 0.7, by=0.01, published="0.7"),),
    ),
    Experiment(
        "mitsunaga-canon",
        "the Canon's ratios as truth, stated as 0.5, 0.25, 0.5, 0.5",
        canon_ratios,
        (near("ratios, ours", *CANON, by=0.005, published="converges"),),
    ),
    Experiment(
        "mitsunaga-flat",
        "chi-square of 25 pixels at psi = 0.05, on one frame and on the average of 100",
        flatness,
        (
            near("threshold", 36.4, by=0.05, published="36.4"),
            near("flat patches kept, %", 95, 95, by=1, published="95"),
        ),
    ),
)
