"""Checks of adjust_steps(h, db, D), Ward's histogram trimming: states (h, ceiling, T, trimmings)."""

import numpy as np

from hdrlab.course.checks.compare import finite, parts, points, require, same, states
from hdrlab.tonemap import ward

# the largest slope of ln Ld over ln L
STEEPEST = 1


def ceiling(T, db, D):
    """Return the ceiling of the histogram, for D in nats."""
    return STEEPEST * T * db / D


def solution(h, db, D, **options):
    """Return the states of the library."""
    return list(ward.adjust_steps(h, STEEPEST * db, D, **options))


def states_of(subject, h, db, D, **options):
    """Return the states of a subject for a range of D nats, passed as on the sheet."""
    extent = D
    return states(subject.adjust_steps(h, db, extent, **options))


def draw_inputs(rng, bins=50):
    """Return h (bins,), db and D: a scene with two peaks and a larger range than the display.

    The paper's pseudo-code compares the trimmings with the first T; Ward's program pcond compares
    them with the T before each trim. For this histogram both stop after the same trim.
    """
    b = np.arange(bins)
    D = float(np.log(100))
    while True:
        tall = 900 * np.exp(-(((b - rng.integers(8, 20)) / 1.2) ** 2))
        low = 300 * np.exp(-(((b - 36) / 1.5) ** 2))
        h = np.round(20 + tall + low + rng.uniform(0, 3, bins))
        db = float(rng.uniform(0.18, 0.24))
        trims = [
            (state.trimmings / h.sum(), state.trimmings / state.T) for state in solution(h, db, D)
        ]
        if all(first > 0.028 or own < 0.022 for first, own in trims) and len(trims) > 3:
            return h, db, D


def get_answer(subject, h, db, D, **options):
    """Return h after each trim."""
    answer = states_of(subject, h, db, D, **options)
    raw_histograms = [state[0] if isinstance(state, tuple | list) else state for state in answer]
    histograms = [finite(state, h.shape, what="h").astype(float) for state in raw_histograms]
    low = h < 25  # far below every ceiling
    message = "h: expected bins far below the ceiling to stay as they are, got smaller ones"
    require(
        np.all(histograms[-1][low] >= 0.9 * h[low]),
        message,
        expected=h,
        answer=histograms[-1],
        kind="curve",
    )
    return histograms


# right iterations may differ in their steps, which small inputs show most
check_one_input = None


@points(4)
def test_nothing_stays_above_the_ceiling(subject, rng):
    """A trim lowers T, and so it lowers the ceiling. Bins that were just below the old ceiling can
    be above the new one.

    Compute T and the ceiling again after each trim, and trim again.

    Stop when the trimmings are below tolerance times T.
    """
    h, db, D = draw_inputs(rng)
    end = get_answer(subject, h, db, D)[-1]
    T = end.sum()
    above = np.maximum(end - ceiling(T, db, D), 0).sum()
    message = (
        f"h: expected at most 3 % of T above the ceiling, got {above / T:.1%} of T; trim again"
    )
    require(
        above <= 0.03 * T,
        message,
        expected=solution(h, db, D)[-1].h,
        answer=end,
        kind="curve",
    )


@points(4)
def test_trimmings_are_not_redistributed(subject, rng):
    """Does a bin grow when you trim another one?

    Throw the trimmings away. If you put them into other bins, the curve becomes too steep there.

    h = minimum(h, ceiling), and nothing else.
    """
    h, db, D = draw_inputs(rng)
    for before, after in zip(
        [h, *get_answer(subject, h, db, D)], get_answer(subject, h, db, D), strict=False
    ):
        message = "h: expected that no bin grows in a trim, got larger ones"
        grown = after > before + 1e-6 * before.max()
        require(not np.any(grown), message, expected=before, answer=after, kind="curve")
    require(after.sum() < h.sum(), "h: expected trims, but the histogram did not change")


@points(4)
def test_the_last_histogram_is_correct(subject, rng):
    """Check your ceiling. The slope of ln Ld over ln L is h D / (T db); the ceiling is the h at
    which this slope is 1.

    ceiling = T db / D.

    D and db are both natural logarithms. Do not mix in log10.
    """
    h, db, D = draw_inputs(rng)
    truth = solution(h, db, D)[-1].h
    same(
        get_answer(subject, h, db, D)[-1],
        truth,
        0.05 * truth.max(),
        what="h after the last trim",
        kind="curve",
    )


@points(3)
def test_a_flat_histogram_is_left_alone(subject, rng):
    """No bin of this scene is above the ceiling, so there is nothing to trim.

    Return h as it came in.

    Do not scale h, and do not normalize it to a density.
    """
    h = np.full(40, float(rng.integers(50, 90)))
    same(get_answer(subject, h, 0.05, float(np.log(100)) / 3)[-1], h, 1e-6, what="h", kind="curve")
    peak = h.copy()
    peak[7] *= 4
    truth = solution(peak, 0.05, float(np.log(100)) / 3)[-1].h
    same(
        get_answer(subject, peak, 0.05, float(np.log(100)) / 3)[-1],
        truth,
        4,
        what="h of one peak",
        kind="curve",
    )


@points(2, needs="test_the_last_histogram_is_correct")
def test_each_state_says_what_was_trimmed_at_which_ceiling(subject, rng):
    """Which four values does a state have, and what are they before the first trim?

    h after the trim, the ceiling, the T before the trim from which it was computed, and the sum of
    what was cut off.

    The first state is (h, infinity, sum of h, infinity).
    """
    h, db, D = draw_inputs(rng)
    first, second = (parts(state, 4, what="a state") for state in states_of(subject, h, db, D)[:2])
    T = h.sum()
    top = ceiling(T, db, D)
    cut = np.maximum(h - top, 0).sum()
    same(first[0], h, 1e-6, what="h of the first state", kind="curve")
    same(first[2], T, 1e-6 * T, what="T of the first state")
    message = "the first state: expected an infinite ceiling and an infinite trimmed amount"
    require(np.isposinf(first[1]) and np.isposinf(first[3]), message)
    same(second[1], top, 1e-6 * T, what="the ceiling of the first trim")
    same(second[2], T, 1e-6 * T, what="T of the first trim")
    same(second[3], cut, 1e-6 * T, what="the trimmed amount of the first trim")


@points(2, needs="test_the_last_histogram_is_correct")
def test_tolerance_decides_when_to_stop(subject, rng):
    """When is a trim the last one?

    When it cuts off less than `tolerance` of the T before it, or when at most `tolerance` of the
    first T is left.

    With a wide display range, every trim cuts off most of what is left: then the second condition
    ends the loop.
    """
    h, db, D = draw_inputs(rng)
    for tolerance, width in ((0.2, db), (0.005, db), (0.05, db / 20)):
        expected = solution(h, width, D, tolerance=tolerance)
        answer = states_of(subject, h, width, D, tolerance=tolerance)
        what = f"the number of states with tolerance={tolerance} and db={width:.3g}"
        same(len(answer), len(expected), 1, what=what)  # 1: of which T the fraction is taken
