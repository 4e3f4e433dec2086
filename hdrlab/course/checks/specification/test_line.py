"""Checks of line(S, V), the photon transfer line: its slope 1 / K, in levels per electron."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same


def draw_inputs(rng, M=9):
    """Return S (M,) and V (M,) on a line through the dark pair, which comes first."""
    S = np.concatenate([[0], np.sort(rng.uniform(100, 3000, M - 1))])
    return S, S / rng.uniform(1, 4) + rng.uniform(3, 12)


def is_valid_input(S, V):
    """Return whether there is a dark pair and two others."""
    return len(np.unique(S)) == len(S) >= 3


@points(2)
def test_the_line_starts_at_the_dark_pair(subject, rng):
    """By how much does the variance grow with the signal, beyond the variance of the dark pair?

    Every pair contains the read noise, and the dark pair contains nothing else.

    Subtract V[0] from all V. The rest is S / K.
    """
    S, V = draw_inputs(rng)
    slope = (V[-1] - V[0]) / S[-1]
    same(subject.line(S, V), slope, 1e-3 * slope, what="1 / K")


@points(7)
def test_pairs_with_uncertain_variances_have_smaller_weights(subject, rng):
    """Which of the measured variances is most certain?

    The error of a measured variance is proportional to the variance itself, so the weight is w = 1
    / V^2.

    1 / K = sum(w S (V - V[0])) / sum(w S^2). The line always goes through the dark pair.
    """
    for read_noise in (0, 1000):  # with much of it, all weights are alike
        S, V = draw_inputs(rng)
        V = V + read_noise
        V = V * (1 + 0.3 * (S > S[-4]) + rng.uniform(-0.05, 0.05, len(V)))
        slope = np.sum(S * (V - V[0]) / V**2) / np.sum((S / V) ** 2)
        same(subject.line(S, V), slope, 2e-3 * slope, what="1 / K of noisy pairs")


@points(1, needs="test_the_line_starts_at_the_dark_pair")
def test_halving_the_level_step_doubles_the_slope(subject, rng):
    """With one more bit, S doubles. What happens to V?

    V becomes four times as large, because a variance is a square.

    Do not put a number with a fixed unit into the slope.
    """
    S, V = draw_inputs(rng)
    before = float(finite(subject.line(S, V), (), what="1 / K"))
    same(
        subject.line(2 * S, 4 * V),
        2 * before,
        1e-3 * before,
        what="1 / K with twice as many levels",
    )
