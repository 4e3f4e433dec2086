"""The experiments of Mitsunaga and Nayar 1999: random cameras, two frames of unknown ratio, the Canon.

error  mean of |f - truth| over the pixel levels, percent of the range
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hdrlab.response import ambiguity, marginal, mitsunaga, polynomial
from hdrlab.response.pairs import average, moments

Float = NDArray[np.float64]
STATED = np.full(3, 0.5)
CANON, CANON_STATED = np.array([0.419, 0.292, 0.570, 0.512]), np.array([0.5, 0.25, 0.5, 0.5])
TRUST = 0.058  # standard deviation of ln R where R is uniform in 0.45 ... 0.55
SEED, OTHER_SEEDS = 0, tuple(range(1, 11))


class Trials(NamedTuple):
    """Section 5, trial by trial: errors and turns of the paper's scheme, errors of ours (if run)."""

    paper: Float
    turns: NDArray[np.intp]
    ours: Float


def section5(*, seed: int = SEED, trials: int = 100, ours: bool = True) -> Trials:
    """Return the Trials of a seed [Mitsunaga99 fig. 3: at most 2.7 %, fewer than 10 turns].

    `ambiguity.trial` states the distributions. Ours takes about a second a trial.
    """
    rng = np.random.default_rng(seed)
    paper, turns, better = [], [], []
    for _ in range(trials):
        one = ambiguity.trial(rng)
        states = list(mitsunaga.fit_steps(moments(average(one.Z)[None]), STATED, 5))
        paper.append(ambiguity.mean_error(states[-1].c[0], one.c))
        turns.append(len(states))
        if ours:
            state = marginal.fit(one.Z, states[-1].c[0], states[-1].R, stated=STATED, trust=TRUST)
            better.append(ambiguity.mean_error(state.c, one.c))
    return Trials(np.array(paper), np.array(turns), np.array(better))


def figure4(*, seed: int = SEED, sigma: float = 0.0) -> ambiguity.Valley:
    """Return the error along the ratio of two frames, truth 0.7, and what a search from 0.625 finds."""
    return ambiguity.valley(polynomial.random(np.random.default_rng(seed)), sigma=sigma)


def canon(*, seed: int = SEED) -> tuple[Float, Float]:
    """Return the ratios (4,) of the Canon as the paper's scheme and ours find them, from the stated ones."""
    one = ambiguity.trial(np.random.default_rng(seed), ratios=CANON)
    paper = mitsunaga.fit(moments(average(one.Z)[None]), CANON_STATED, 5)
    return paper.R, marginal.fit(one.Z, paper.c[0], paper.R).R
