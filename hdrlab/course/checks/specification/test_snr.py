"""Checks of snr(g, least, span), the weight as signal-to-noise ratio: w (n,). Its scale is free."""

import numpy as np

from hdrlab.core import weights
from hdrlab.course.checks.compare import finite, points, same
from hdrlab.course.checks.laws import drawn_response


def draw_inputs(rng, n):
    """Return the response g (n,) of a random camera."""
    M = (np.arange(n) + 0.5) / n
    return np.log(drawn_response(rng).inverse(M))


def get_answer(subject, g, **options):
    """Return w (n,) divided by the weight in the middle."""
    w = finite(subject.snr(g, **options), (len(g),), what="w").astype(float)
    return w / w[len(g) // 2]


SMALL_INPUTS = [
    (np.array([0.0, 0.01, 0.03, 0.04, 0.06]), {"least": 0.01, "span": 1}),
    (np.array([0.0, 0.01, 0.01, 0.01, 0.06]), {"least": 0.5, "span": 1}),
    (np.array([0.0, 0.01, 0.03, 0.04, 0.05, 0.07, 0.08]), {"least": 0.01, "span": 2}),
]


def check_one_input(subject, g, **options):
    """Compare the weights, divided by the weight in the middle."""
    expected = weights.snr(g, **options)
    same(get_answer(subject, g, **options), expected, 0.02 * expected.max(), what="w")


@points(5)
def test_the_weight_is_the_signal_over_its_slope(subject, rng):
    """The noise has the same size at all pixel values. How large is the error of the exposure that
    it causes?

    The error is proportional to the slope f' of the curve. The signal is f itself.

    w = f / f' with f = exp(g). Compute f' from the pixel values `span` below and `span` above.
    """
    g = draw_inputs(rng, 2 * int(rng.integers(80, 140)))
    span = int(rng.integers(2, 4))
    # ripples that a slope over `span` levels on either side does not see
    g += 0.003 * np.sin(np.pi * np.arange(len(g)) / span + rng.uniform(0.5, 1))
    answer = get_answer(subject, g, least=0.01, span=span)
    expected = weights.snr(g, least=0.01, span=span)
    same(answer[1:-1], expected[1:-1], 0.02 * expected.max(), what="w", kind="curve")


@points(2)
def test_clipped_levels_have_weight_0(subject, rng):
    """What does a pixel of value 0 or n - 1 tell you about the light?

    Only "at most" or "at least".

    w(0) = w(n - 1) = 0.
    """
    g = draw_inputs(rng, 100)
    same(
        get_answer(subject, g, least=0.01, span=4)[[0, -1]],
        [0, 0],
        1e-6,
        what="the weights of the lowest and the highest level",
    )


@points(2)
def test_the_weight_is_bounded_where_the_curve_is_flat(subject, rng):
    """Where the curve is flat, f' is 0. What is f / f' there?

    Replace slopes below `least` times the mean slope by this limit.

    The mean slope is (f(n - 1) - f(0)) / (n - 1).
    """
    g = draw_inputs(rng, 120)
    # flat from level 70 to level 100
    g[100:] -= g[100] - g[70]
    g[70:100] = g[70]
    expected = weights.snr(g, least=0.2, span=3)
    answer = get_answer(subject, g, least=0.2, span=3)
    same(
        answer, expected, 0.02 * expected.max(), what="w of a curve with a flat part", kind="curve"
    )


@points(1, needs="test_the_weight_is_the_signal_over_its_slope")
def test_the_unit_of_the_exposure_cancels(subject, rng):
    """g is known up to a constant. What does this constant do to f and to f'?

    It multiplies both by the same factor, so w must not change.

    `least` is relative to the mean slope of f, so compute the mean slope from the same f.
    """
    g = draw_inputs(rng, 100)
    before = get_answer(subject, g, least=0.05, span=4)
    answer = get_answer(subject, g + rng.uniform(-3, 3), least=0.05, span=4)
    same(answer, before, 1e-2 * before.max(), what="w with another unit of exposure", kind="curve")
