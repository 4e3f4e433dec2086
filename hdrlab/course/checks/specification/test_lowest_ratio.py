"""Checks of lowest_ratio(F, G), the share of veiling glare in a map: (share, agreement)."""

import numpy as np

from hdrlab.course.checks.compare import numbers, parts, points, require, same
from hdrlab.radiance import flare

SHAPE = (100, 140)


def draw_inputs(rng):
    """Return F and G (H, W) of a map in which a share of the light is glare; one pixel is defective."""
    G = np.exp(rng.normal(0, 1, SHAPE))
    ratios = rng.uniform(0.02, 0.06) + 0.3 * np.sqrt(rng.random(SHAPE))
    ratios[50, int(rng.integers(20, 120))] = 0.003
    return (G * ratios).astype(np.float32), G.astype(np.float32)


def get_answer(subject, F, G):
    return parts(subject.lowest_ratio(F, G), 2, what="share and agreement")


def same_share(subject, F, G):
    share, _ = flare.lowest_ratio(F, G)
    same(get_answer(subject, F, G)[0], share, 2e-3 * share, what="the share")


# the ratio needs 5000 pixels
check_one_input = None


@points(5)
def test_the_share_is_extrapolated_from_two_low_quantiles(subject, rng):
    """Nothing is darker than the glare. Which ratio F / G is then the share?

    The lowest one. But the lowest ratio of all may be a broken pixel, so quantiles are used.

    share = 2 q1 - q2, with the quantiles of 0.0002 and 0.001 of all ratios.
    """
    same_share(subject, *draw_inputs(rng))


@points(3)
def test_the_agreement_is_the_quotient_of_a_high_and_the_lowest_ratio(subject, rng):
    """With glare, many dark places have nearly the same ratio. How can you measure this?

    Compare a higher quantile of the ratios with the lowest one.

    agreement = q3 / q1, with the quantiles of 0.01 and 0.0002.
    """
    F, G = draw_inputs(rng)
    _, agreement = flare.lowest_ratio(F, G)
    answer = get_answer(subject, F, G)[1]
    same(answer, agreement, 2e-3 * agreement, what="the agreement")


@points(3)
def test_pixels_without_glare_do_not_count(subject, rng):
    """Where G is 0, no light arrives from elsewhere. What do these pixels say about the share?

    Nothing: F / G is not defined.

    Take the quantiles of the ratios with G above 0 only.
    """
    F, G = draw_inputs(rng)
    G[rng.random(SHAPE) < 0.3] = 0
    same_share(subject, F, G)


@points(2, needs="test_the_share_is_extrapolated_from_two_low_quantiles")
def test_the_share_is_not_negative_and_needs_5000_pixels(subject, rng):
    """A quantile of 0.0002 of a thousand pixels: how many pixels lie below it?

    Not even one. Fewer than 5000 pixels with G above 0 show nothing: share 0, agreement inf.

    If the ratios rise steeply, 2 q1 - q2 is negative. Return 0 then.
    """
    F, G = draw_inputs(rng)
    share, agreement = get_answer(subject, F[:20], G[:20])
    same(share, 0, 0, what="the share in a small map")
    require(np.isposinf(numbers(agreement, what="the agreement")).all(), "the agreement is not inf")
    for count, what in ((4990, "fewer than 5000"), (5010, "more than 5000")):
        few = G.copy()
        few.flat[count:] = 0
        expected, _ = flare.lowest_ratio(F, few)
        answer = get_answer(subject, F, few)[0]
        same(answer, expected, 2e-3 * expected, what=f"the share for {what} pixels with G above 0")
    steep = F * np.where(rng.random(SHAPE) < 3e-4, 0.01, 1).astype(np.float32)
    steep.flat[:4] = 1e-4 * G.flat[:4]
    same(get_answer(subject, steep, G)[0], 0, 0, what="the share where the ratios rise steeply")
