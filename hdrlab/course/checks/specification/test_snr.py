"""The weight of the signal over the noise: snr(g, least, span) -> w (n,). Its scale is free."""

import numpy as np

from hdrlab.core import weights
from hdrlab.course.checks.compare import finite, points, same
from hdrlab.course.checks.laws import drawn_response


def drawn(rng, n):
    """Return the response g (n,) of a camera that nobody has seen."""
    M = (np.arange(n) + 0.5) / n
    return np.log(drawn_response(rng).inverse(M))


def asked(subject, g, **knobs):
    """Return w (n,) in units of the weight in the middle."""
    w = finite(subject.snr(g, **knobs), (len(g),), what="w").astype(float)
    return w / w[len(g) // 2]


@points(5)
def test_a_level_counts_as_its_signal_over_its_slope(subject, rng):
    """Noise of one size in the levels: what does it do to the exposure?

    It moves the exposure by the slope f' of the curve. The signal is f itself.

    w = f / f', f = exp g, and f' over `span` levels on either side.
    """
    g, span = drawn(rng, 2 * int(rng.integers(80, 140))), int(rng.integers(2, 4))
    # ripples that a slope over `span` levels on either side does not see
    g += 0.003 * np.sin(np.pi * np.arange(len(g)) / span + rng.uniform(0.5, 1))
    came, expected = asked(subject, g, least=0.01, span=span), weights.snr(g, least=0.01, span=span)
    same(came[1:-1], expected[1:-1], 0.02 * expected.max(), what="w", kind="curve")


@points(2)
def test_clipped_levels_do_not_count(subject, rng):
    """What does a pixel of the lowest level say? And one of the highest?

    Only "at most" and "at least".

    w(0) = w(n - 1) = 0.
    """
    g = drawn(rng, 100)
    same(
        asked(subject, g, least=0.01, span=4)[[0, -1]], [0, 0], 1e-6, what="the weights of the ends"
    )


@points(2)
def test_where_the_curve_is_level_the_weight_is_bounded(subject, rng):
    """Where the curve is level, f' is 0. And f / f'?

    `least` is the smallest slope that counts, in units of the mean slope.

    The mean slope is (f(n - 1) - f(0)) / (n - 1).
    """
    g = drawn(rng, 120)
    g[70:100], g[100:] = g[70], g[100:] - g[100] + g[70]
    expected, came = weights.snr(g, least=0.2, span=3), asked(subject, g, least=0.2, span=3)
    same(came, expected, 0.02 * expected.max(), what="w of a level", kind="curve")


@points(1, needs="test_a_level_counts_as_its_signal_over_its_slope")
def test_the_unit_of_the_exposure_cancels(subject, rng):
    """g is known but for a constant. What does a constant do to f? And to f'?

    It multiplies both by the same factor.

    Measure `least` in the mean slope of this very f.
    """
    g = drawn(rng, 100)
    before = asked(subject, g, least=0.05, span=4)
    came = asked(subject, g + rng.uniform(-3, 3), least=0.05, span=4)
    same(came, before, 1e-2 * before.max(), what="w in another unit", kind="curve")
