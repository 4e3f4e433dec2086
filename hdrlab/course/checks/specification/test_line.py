"""The photon transfer line: line(S, V) -> its slope 1 / K, one per electron and level."""

import numpy as np

from hdrlab.course.checks.compare import finite, points, same


def drawn(rng, M=9):
    """Return S (M,) and V (M,) on a line through the dark pair, which is the first."""
    S = np.concatenate([[0], np.sort(rng.uniform(100, 3000, M - 1))])
    return S, S / rng.uniform(1, 4) + rng.uniform(3, 12)


@points(2)
def test_the_slope_of_a_line_is_found_from_the_dark_pair_on(subject, rng):
    """How much does the variance grow with the signal, beyond that of the dark?

    The read noise is in every pair, and in the dark one alone.

    Take V[0] off all V: what is left is S / K.
    """
    S, V = drawn(rng)
    slope = (V[-1] - V[0]) / S[-1]
    same(subject.line(S, V), slope, 1e-3 * slope, what="1 / K")


@points(7)
def test_a_pair_counts_the_less_the_more_its_variance_errs(subject, rng):
    """Which of the variances is known best?

    Measured in n pixels a variance errs in proportion to itself: the weight is 1 / V^2.

    1 / K = sum w S (V - V_0) / sum w S^2: the dark pair is on the line, whatever the others say.
    """
    S, V = drawn(rng)
    V = V * (1 + 0.3 * (S > S[-4]) + rng.uniform(-0.05, 0.05, len(V)))
    slope = np.sum(S * (V - V[0]) / V**2) / np.sum((S / V) ** 2)
    same(subject.line(S, V), slope, 2e-3 * slope, what="1 / K of scattered pairs")


@points(1, needs="test_the_slope_of_a_line_is_found_from_the_dark_pair_on")
def test_levels_half_as_large_double_the_slope(subject, rng):
    """With one bit more, S doubles. And V?

    The variance is a square: it becomes four times as large.

    Nothing in the slope has a size of its own.
    """
    S, V = drawn(rng)
    before = float(finite(subject.line(S, V), (), what="1 / K"))
    same(subject.line(2 * S, 4 * V), 2 * before, 1e-3 * before, what="1 / K in half levels")
